// SPDX-License-Identifier: Apache-2.0
// Copies of nodes, and patches made of some nodes of another.
#include "dsp/core/error.hpp"
#include "graph/edit/patch_arrange.hpp"
#include "graph/edit/patch_editing.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tactus::edit {

namespace fs = std::filesystem;

namespace {

patch::Patch read(std::string_view text) {
    patch::Problems problems;
    patch::Patch read = patch::read_patch(text, "copy.toml", problems);
    if (!problems.empty() && read.nodes.empty()) throw Error("the text has no nodes of a patch");
    return read;
}

NewNode node_of(const patch::PatchNode& node) {
    NewNode made{node.name, node.type, node.rate, node.group, {}, {}};
    for (const OptionText& setting : node.settings) made.settings.emplace_back(setting.name, setting.text);
    return made;
}

WireText text_of(const patch::PatchWire& wire) {
    return {wire.from_port.empty() ? wire.from_node : wire.from_node + "." + wire.from_port,
            wire.to_node + "." + wire.to_port, mode_text(wire)};
}

bool is_asset(const patch::PatchWire& wire) { return wire.from_port.empty(); }

void put_group(Editing& editing, const patch::PatchGroup& group, const std::string& name) {
    const Editing::Path owner{"groups", name};
    editing.put(owner, "rate", toml_quoted(group.rate));
    if (!group.latency.empty()) editing.put(owner, "latency", toml_quoted(group.latency));
    if (group.backlog >= 0) editing.put(owner, "backlog", std::to_string(group.backlog));
}

/// Groups and assets that nodes name, for a text that has the nodes.
std::string with_surroundings(std::string text, const patch::Patch& patch, const std::set<std::string>& nodes,
                              const fs::path& folder) {
    Editing editing(text);
    std::set<std::string> groups, names;
    for (const patch::PatchNode& node : patch.nodes) {
        if (!nodes.contains(node.name)) continue;
        groups.insert(node.group);
        for (const OptionText& setting : node.settings) names.insert(setting.text);
    }
    for (const patch::PatchWire& wire : patch.wires)
        if (is_asset(wire) && nodes.contains(wire.to_node)) names.insert(wire.from_node);
    for (const patch::PatchGroup& group : patch.groups) {
        if (!groups.contains(group.name)) continue;
        put_group(editing, group, group.name);
    }
    for (const patch::PatchAsset& asset : patch.assets)
        if (names.contains(asset.name))
            editing.put({"assets"}, asset.name,
                        toml_quoted(asset.path.is_absolute() ? asset.path.string()
                                                             : (folder / asset.path).lexically_normal().string()));
    return editing.result();
}

/// A patch's text with some nodes of another and the wires between them.
std::string part_of(const patch::Patch& patch, const std::set<std::string>& nodes, const fs::path& folder) {
    std::vector<NewNode> made;
    for (const patch::PatchNode& node : patch.nodes) {
        if (!nodes.contains(node.name)) continue;
        NewNode& copy = made.emplace_back(node_of(node));
        if (!patch::is_sub_patch(node)) continue;
        const fs::path file(copy.type.substr(patch::sub_patch_prefix.size()));
        if (file.is_relative())
            copy.type = std::string(patch::sub_patch_prefix) + (folder / file).lexically_normal().string();
    }
    for (const patch::PatchWire& wire : patch.wires)
        if (!made.empty() && nodes.contains(wire.to_node) && (is_asset(wire) || nodes.contains(wire.from_node)))
            made.back().wires.push_back(text_of(wire));
    std::string text;
    for (const NewNode& node : made) text = with_node(text, node);
    return with_surroundings(std::move(text), patch, nodes, folder);
}

std::set<std::string> set_of(std::span<const std::string> names) { return {names.begin(), names.end()}; }

/// Keeps relative paths as written instead of resolving them against `folder`.
patch::Patch read_in(std::string_view text, const fs::path& folder) {
    patch::Problems ignored;
    return patch::read_patch(text, folder / "copy.toml", ignored);
}

/// The colours of some nodes, each under the name that it has in `text`.
std::string with_colours_of(std::string text, const patch::PatchWindow& window,
                            const std::map<std::string, std::string>& names) {
    for (const auto& [node, name] : names)
        if (const auto found = window.colours.find(node); found != window.colours.end())
            text = with_colours(text, std::span(&name, 1), found->second);
    return text;
}

std::map<std::string, patch::PatchPlace> places_of(const patch::PatchWindow& window,
                                                   std::span<const std::string> names) {
    std::map<std::string, patch::PatchPlace> places;
    for (const std::string& name : names)
        if (const auto found = window.places.find(name); found != window.places.end()) places.insert(*found);
    return places;
}

/// What groups or assets of a copy are called in the patch that takes them: their own name, unless that is something
/// else there.
template <class Named, class Same>
std::map<std::string, std::string> names_here(const std::vector<Named>& copied, const std::vector<Named>& here,
                                              Same&& are_same) {
    std::map<std::string, std::string> names;
    // A new name must not be that of another one of the copy, either.
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::find(copied, name, &Named::name) != copied.end() ||
               std::ranges::any_of(names, [&](const auto& given) { return given.second == name; });
    };
    for (const Named& one : copied) {
        std::string name = one.name;
        for (int i = 2;; ++i) {
            const auto known = std::ranges::find(here, name, &Named::name);
            if (known == here.end() ? name == one.name || !is_taken(name) : are_same(one, *known)) break;
            name = fmt::format("{}_{}", one.name, i);
        }
        names[one.name] = name;
    }
    return names;
}

std::map<std::string, std::string> same_names(std::span<const std::string> nodes) {
    std::map<std::string, std::string> names;
    for (const std::string& node : nodes) names[node] = node;
    return names;
}

}  // namespace

std::string mode_text(const patch::PatchWire& wire) {
    static constexpr std::string_view modes[] = {"hold", "linear", "batch", "delay"};
    if (!wire.mode_given) return {};
    std::string mode(modes[static_cast<std::size_t>(wire.mode)]);
    if (wire.mode == patch::WireMode::delay) mode += fmt::format(" {}", wire.delay);
    return mode;
}

std::string copied(std::string_view text, std::span<const std::string> names, const fs::path& folder) {
    const patch::PatchWindow window = patch::window_of(text);
    const std::string part = part_of(read_in(text, folder), set_of(names), folder);
    return with_colours_of(with_places(part, places_of(window, names)), window, same_names(names));
}

std::string with_pasted(std::string_view text, std::string_view copy, const std::map<std::string, std::string>& names,
                        patch::PatchPlace by, const fs::path& folder) {
    const patch::Patch patch = read(copy), here = read_in(text, folder);
    const patch::PatchWindow window = patch::window_of(copy);
    const auto name_of = [&](const std::string& name) {
        const auto found = names.find(name);
        return found == names.end() ? name : found->second;
    };
    Editing editing(text);
    // A name that means something else here becomes a new one.
    const auto path_of = [&](const patch::PatchAsset& asset) { return (folder / asset.path).lexically_normal(); };
    const auto groups =
        names_here(patch.groups, here.groups, [](const patch::PatchGroup& a, const patch::PatchGroup& b) {
            return a.rate == b.rate && a.latency == b.latency && a.backlog == b.backlog;
        });
    const auto assets =
        names_here(patch.assets, here.assets, [&](const patch::PatchAsset& a, const patch::PatchAsset& b) {
            return folder.empty() || path_of(a) == path_of(b);
        });
    for (const patch::PatchGroup& group : patch.groups)
        if (std::ranges::find(here.groups, groups.at(group.name), &patch::PatchGroup::name) == here.groups.end())
            put_group(editing, group, groups.at(group.name));
    for (const patch::PatchAsset& asset : patch.assets)
        if (std::ranges::find(here.assets, assets.at(asset.name), &patch::PatchAsset::name) == here.assets.end())
            editing.put({"assets"}, assets.at(asset.name), toml_quoted(asset.path.string()));
    std::vector<NewNode> added;
    for (const patch::PatchNode& node : patch.nodes) {
        NewNode& made = added.emplace_back(node_of(node));
        made.name = name_of(node.name);
        if (const auto group = groups.find(made.group); group != groups.end()) made.group = group->second;
        for (auto& [param, value] : made.settings)
            if (const auto asset = assets.find(value); asset != assets.end()) value = asset->second;
    }
    for (const patch::PatchWire& wire : patch.wires) {
        patch::PatchWire renamed = wire;
        if (!is_asset(wire)) renamed.from_node = name_of(wire.from_node);
        else if (const auto asset = assets.find(wire.from_node); asset != assets.end())
            renamed.from_node = asset->second;
        renamed.to_node = name_of(wire.to_node);
        if (!added.empty()) added.back().wires.push_back(text_of(renamed));
    }
    std::string made = editing.result();
    for (const NewNode& node : added) made = with_node(made, node);
    std::map<std::string, patch::PatchPlace> places;
    for (const auto& [node, place] : window.places) places[name_of(node)] = {place.x + by.x, place.y + by.y};
    std::map<std::string, std::string> coloured;
    for (const patch::PatchNode& node : patch.nodes) coloured[node.name] = name_of(node.name);
    return with_colours_of(with_places(made, places), window, coloured);
}

SubPatch with_sub_patch(std::string_view text, std::span<const std::string> nodes, std::string_view name,
                        std::string_view file, const fs::path& folder) {
    const patch::Patch patch = read_in(text, folder);
    const std::set<std::string> chosen = set_of(nodes);
    if (chosen.empty()) throw Error("choose the nodes of the sub-patch first");
    SubPatch made{without_nodes(text, nodes), part_of(patch, chosen, folder)};
    if (!made.inner.starts_with("title")) made.inner = fmt::format("title = {}\n", toml_quoted(name)) + made.inner;
    Editing inner(made.inner);
    std::map<std::string, std::string> inputs, outputs;  // "node.port" within, its name outside
    std::set<std::string> taken;
    const auto end_of = [&](std::map<std::string, std::string>& ends, const char* table, const std::string& node,
                            const std::string& port) {
        const std::string within = node + "." + port;
        if (const auto known = ends.find(within); known != ends.end()) return known->second;
        std::string called = port;
        for (int i = 1; !taken.insert(called).second; ++i)
            called = fmt::format("{}_{}{}", node, port, i == 1 ? "" : std::to_string(i));
        inner.put({table}, called, toml_quoted(within));
        return ends[within] = called;
    };
    std::vector<WireText> wires;
    for (const patch::PatchWire& wire : patch.wires) {
        const bool begins = !is_asset(wire) && chosen.contains(wire.from_node), ends = chosen.contains(wire.to_node);
        if (begins == ends || is_asset(wire)) continue;
        WireText crossing = text_of(wire);
        if (ends) crossing.to = fmt::format("{}.{}", name, end_of(inputs, "inputs", wire.to_node, wire.to_port));
        else crossing.from = fmt::format("{}.{}", name, end_of(outputs, "outputs", wire.from_node, wire.from_port));
        wires.push_back(std::move(crossing));
    }
    // The nodes keep their positions inside; the sub-patch is placed where the first of them was.
    const patch::PatchWindow window = patch::window_of(text);
    const std::map<std::string, patch::PatchPlace> places = places_of(window, nodes);
    made.inner = with_colours_of(with_places(inner.result(), places), window, same_names(nodes));
    made.outer = with_node(made.outer,
                           {std::string(name), fmt::format("{}{}", patch::sub_patch_prefix, file), {}, {}, {}, wires});
    if (places.empty()) return made;
    patch::PatchPlace first = places.begin()->second;
    for (const auto& [node, place] : places) first = {std::min(first.x, place.x), std::min(first.y, place.y)};
    made.outer = with_places(made.outer, {{std::string(name), first}});
    return made;
}

}  // namespace tactus::edit
