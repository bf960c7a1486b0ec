// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/decide_types.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tactus::compile {

namespace {

bool is_open(const PlanNode& node) {
    return std::ranges::any_of(node.outputs, [](const PlanOutput& o) { return o.port->type == &value::undecided; });
}

/// A wire into a node whose type is open.
struct Feed {
    const Output* from = nullptr;
    PlanNode* to = nullptr;
    const Input* input = nullptr;
};

/// The type comes in by `feed`: the node's outputs have it from now on, and its inputs, those without a wire too.
void decide(const Feed& feed) {
    for (const PlanOutput& output : feed.to->outputs)
        if (output.port->type == &value::undecided) output.port->type = feed.from->type;
    for (const PlanInput& input : feed.to->inputs)
        if (input.port->kind == InputKind::any) input.port->type = feed.from->type;
}

}  // namespace

void decide_types(Plan& plan) {
    std::unordered_map<std::string_view, PlanNode*> nodes;
    bool some_are_open = false;
    for (PlanNode& node : plan.nodes) {
        nodes.emplace(node.name, &node);
        some_are_open |= is_open(node);
    }
    if (!some_are_open) return;
    std::vector<Feed> feeds;
    for (const patch::PatchWire& wire : plan.patch.wires) {
        const auto from = nodes.find(wire.from_node), to = nodes.find(wire.to_node);
        if (from == nodes.end() || to == nodes.end() || !is_open(*to->second)) continue;
        const auto output = std::ranges::find(from->second->outputs, wire.from_port, &PlanOutput::name);
        const auto input = std::ranges::find(to->second->inputs, wire.to_port, &PlanInput::name);
        if (output == from->second->outputs.end() || input == to->second->inputs.end()) continue;
        if (input->port->kind == InputKind::any) feeds.push_back({output->port, to->second, input->port});
    }
    // Each round decides at least one node, or is the last.
    for (bool has_decided = true; has_decided;) {
        has_decided = false;
        for (const Feed& feed : feeds) {
            if (feed.from->type == &value::undecided || !is_open(*feed.to)) continue;
            if (!(feed.input->takes & kind_of(*feed.from->type))) continue;
            decide(feed);
            has_decided = true;
        }
    }
}

}  // namespace tactus::compile
