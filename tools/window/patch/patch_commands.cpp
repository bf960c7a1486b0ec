// SPDX-License-Identifier: Apache-2.0
// What can be done with what a patch has, by name: for the list of commands, and so for the keyboard.
#include "tools/window/patch/patch_panel.hpp"

#include "graph/patch/sub_patch.hpp"
#include "tools/window/patch/wire_choices.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::window {

namespace {

/// The first words of a comment.
std::string beginning(const std::string& text) {
    constexpr std::size_t most = 40;
    std::string words = text.substr(0, std::min(text.find('\n'), text.size()));
    if (words.size() <= most) return words;
    words.resize(most);
    while (!words.empty() && (static_cast<unsigned char>(words.back()) & 0xC0) == 0x80) words.pop_back();
    if (!words.empty() && static_cast<unsigned char>(words.back()) >= 0xC0) words.pop_back();
    return words + "…";
}

}  // namespace

void PatchPanel::add_commands(std::vector<Command>& all, bool is_seen) {
    if (is_read_only) return;
    if (is_seen && !chosen.empty()) {
        for (const std::string& colour : patch::colour_names())
            all.push_back({"colour", "Colour the chosen nodes: " + colour, "", "color paint",
                           [this, colour] { bench_.colour(chosen_nodes(), colour); }});
        all.push_back({"colour", "Colour the chosen nodes: none", "", "color paint",
                       [this] { bench_.colour(chosen_nodes(), ""); }});
        all.push_back({"place", "Place the chosen nodes automatically", "", "arrange",
                       [this] { bench_.place_automatically(chosen_nodes()); }});
    }
    for (const patch::PatchNode& node : bench_.written().nodes) {
        if (!patch::is_sub_patch(node)) continue;
        const bool is_open = std::ranges::find(bench_.window().open, node.name) != bench_.window().open.end();
        all.push_back({"sub-patch", fmt::format("{} the sub-patch {}", is_open ? "Close" : "Open", node.name), "",
                       "show hide within",
                       [this, name = node.name, is_open] { bench_.open_sub_patch(name, !is_open); }});
    }
    for (const patch::PatchComment& comment : bench_.window().comments) {
        const std::string words = beginning(comment.text);
        if (is_seen)
            all.push_back({"comment", fmt::format("Change the comment '{}'...", words), "", "note text",
                           [this, name = comment.name] { commented_ = name; }});
        all.push_back({"comment", fmt::format("Remove the comment '{}'", words), "", "note text delete",
                       [this, name = comment.name] { bench_.remove_comment(name); }});
    }
    if (bench_.has_lane(selected))
        for (const PictureLane& lane : bench_.picture().lanes)
            if (lane.name.find(patch::within_node) == std::string::npos)
                all.push_back({"lane", fmt::format("Run {} at {}", selected, lane.name), "", "rate group lane move",
                               [this, name = selected, to = lane.name] { bench_.move_to_lane({name}, to); }});
    add_wire_commands(all);
}

void PatchPanel::add_wire_commands(std::vector<Command>& all) {
    const PatchPicture& picture = bench_.picture();
    constexpr std::size_t max_changed = 500, max_wires = 4000;
    std::size_t changed = 0;
    for (const PictureWire& wire : picture.wires) {
        if (++changed > max_changed) break;
        const std::string a = end_name({Hit::What::output, wire.from, wire.output}),
                          b = end_name({Hit::What::input, wire.to, wire.input});
        all.push_back({"wire", fmt::format("Remove the wire {} to {}", a, b), "", "disconnect delete",
                       [this, a, b] { bench_.disconnect(b, a); }});
        for (const char* mode : {"hold", "linear", "batch", "delay 1"})
            all.push_back({"wire", fmt::format("Deliver {} to {} as {}", a, b, mode), "", "mode wire",
                           [this, a, b, mode] { bench_.connect(a, b, mode); }});
    }
    const WireChoices choices = wire_choices(picture, max_wires);
    for (const auto& [from, to, drives] : choices.list)
        all.push_back({"wire", fmt::format("Wire {} to {}", from, to), "", drives ? "drive parameter" : "connect",
                       [this, from, to] { bench_.connect(from, to); }});
    if (choices.has_more)
        all.push_back({"wire", fmt::format("Only {} of the possible wires are listed", max_wires), "",
                       "connect drive parameter more", [] {}, [] { return false; }});
}

}  // namespace tactus::window
