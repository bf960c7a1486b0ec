// SPDX-License-Identifier: Apache-2.0
// The force on a hand as a tone, for somebody whose hand no device pushes.
#include "tools/window/document/workbench.hpp"

#include "graph/edit/patch_arrange.hpp"
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace tactus::window {

namespace {

constexpr const char *tone = "force_tone", *sound = "force_sound", *sound_rate = "48 kHz";

/// "hand_out.applied"; empty: the patch has no hand.
std::string force_of(const patch::Patch& patch) {
    const auto all = nodes::catalogue();
    for (const patch::PatchNode& node : patch.nodes) {
        const auto type = std::ranges::find(all, node.type, [](const NodeType* t) { return t->name; });
        if (type == all.end() || (*type)->role != NodeRole::hand_sink) continue;
        const TypePorts* ports = ports_of_type(node.type);
        for (const PicturePort& port : ports->outputs)
            if (port.name == "applied" && port.type == &value::wrench) return node.name + ".applied";
    }
    return {};
}

}  // namespace

bool Workbench::can_hear_force() const { return !force_of(written_).empty(); }

bool Workbench::hears_force() const {
    return std::ranges::find(written_.nodes, tone, &patch::PatchNode::type) != written_.nodes.end();
}

bool Workbench::hear_force(bool wanted) {
    if (wanted == hears_force()) return true;
    if (!wanted) {
        std::set<std::string> tones, played, others;
        for (const patch::PatchNode& node : written_.nodes)
            if (node.type == tone) tones.insert(node.name);
        for (const patch::PatchWire& wire : written_.wires)
            if (wire.to_node.starts_with(sound))
                (tones.contains(wire.from_node) ? played : others).insert(wire.to_node);
        // With the outputs that play nothing else, each once.
        std::vector<std::string> made(tones.begin(), tones.end());
        std::ranges::set_difference(played, others, std::back_inserter(made));
        return edit([&](std::string_view text) { return edit::without_nodes(text, made); }, "the force is not heard");
    }
    const std::string force = force_of(written_);
    if (force.empty()) {
        tell("this patch has no hand that gets a force", true);
        return false;
    }
    const std::string tone_name = free_name(tone), sound_name = free_name(sound);
    return edit(
        [&](std::string_view text) {
            const std::string changed =
                edit::with_node(text, {tone_name, tone, sound_rate, "", {}, {{force, tone_name + ".wrench", {}}}});
            return edit::with_node(changed, {sound_name,
                                             "audio_output",
                                             sound_rate,
                                             "",
                                             {},
                                             {{tone_name + ".signal", sound_name + ".signal", {}}}});
        },
        "the force is heard as a tone: the larger, the louder and higher");
}

}  // namespace tactus::window
