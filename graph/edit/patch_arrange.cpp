// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_arrange.hpp"

#include "dsp/core/error.hpp"
#include "graph/edit/patch_editing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::edit {

namespace {

std::string pair_text(patch::PatchPlace place) {
    return fmt::format("[{}, {}]", std::lround(place.x), std::lround(place.y));
}

}  // namespace

std::string with_places(std::string_view text, const std::map<std::string, patch::PatchPlace>& places) {
    Editing editing(text);
    for (const auto& [node, place] : places) editing.put({"window", "places"}, node, pair_text(place));
    return editing.result();
}

std::string without_places(std::string_view text, std::span<const std::string> nodes) {
    Editing editing(text);
    for (const std::string& node : nodes) editing.drop({"window", "places", node});
    return editing.result();
}

std::string with_colours(std::string_view text, std::span<const std::string> nodes, std::string_view colour) {
    Editing editing(text);
    for (const std::string& node : nodes)
        if (colour.empty()) editing.drop({"window", "colours", node});
        else editing.put({"window", "colours"}, node, toml_quoted(colour));
    return editing.result();
}

std::string with_comment(std::string_view text, const patch::PatchComment& comment) {
    Editing editing(text);
    const Editing::Path owner{"window", "comments", comment.name};
    editing.put(owner, "text", toml_quoted(comment.text));
    editing.put(owner, "place", pair_text(comment.place));
    editing.put(owner, "size", pair_text(comment.size));
    if (!comment.colour.empty()) editing.put(owner, "colour", toml_quoted(comment.colour));
    return editing.result();
}

std::string without_comment(std::string_view text, std::string_view name) {
    Editing editing(text);
    if (!editing.drop({"window", "comments", std::string(name)}))
        throw Error(fmt::format("there is no comment '{}'", name));
    return editing.result();
}

std::string with_layout(std::string_view text, std::string_view layout) {
    Editing editing(text);
    editing.put({"window"}, "layout", toml_quoted(layout));
    return editing.result();
}

std::string with_open_parts(std::string_view text, std::span<const std::string> nodes) {
    Editing editing(text);
    std::string list = "[";
    for (const std::string& node : nodes) list += (list.size() > 1 ? ", " : "") + toml_quoted(node);
    editing.put({"window"}, "open", list + "]");
    return editing.result();
}

std::string with_asset(std::string_view text, std::string_view name, std::string_view path) {
    Editing editing(text);
    editing.put({"assets"}, name, toml_quoted(path));
    return editing.result();
}

std::string with_device(std::string_view text, std::string_view name, std::string_view driver) {
    Editing editing(text);
    editing.put({"devices", std::string(name)}, "driver", toml_quoted(driver));
    return editing.result();
}

std::string with_device_setting(std::string_view text, std::string_view device, std::string_view name,
                                std::string_view value) {
    Editing editing(text);
    if (value.empty()) editing.drop({"devices", std::string(device), std::string(name)});
    else editing.set({"devices", std::string(device)}, name, value);
    return editing.result();
}

std::string without_nodes(std::string_view text, std::span<const std::string> names) {
    std::string made(text);
    for (const std::string& name : names) made = without_node(made, name);
    return made;
}

}  // namespace tactus::edit
