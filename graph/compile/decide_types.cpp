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

/// The node's outputs have the type from now on, and its inputs, those without a wire too.
void decide(PlanNode& node, const ValueType& type) {
    for (const PlanOutput& output : node.outputs)
        if (output.port->type == &value::undecided) output.port->type = &type;
    for (const PlanInput& input : node.inputs)
        if (input.port->kind == InputKind::any) input.port->type = &type;
}

/// Carries types along the feeds as far as they reach. False: no node with a feed is open any more.
bool carry_types(const std::vector<Feed>& feeds) {
    bool some_are_open = true;
    // Each round decides at least one node, or is the last.
    for (bool has_decided = true; has_decided;) {
        has_decided = some_are_open = false;
        for (const Feed& feed : feeds) {
            if (!is_open(*feed.to)) continue;
            const ValueType& type = *feed.from->type;
            if (&type == &value::undecided || !(feed.input->takes & kind_of(type))) {
                some_are_open = true;
                continue;
            }
            decide(*feed.to, type);
            has_decided = true;
        }
    }
    return some_are_open;
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
    while (carry_types(feeds)) {
        // What is left is cycles that no type comes into. They carry numbers, so that they are refused as cycles.
        const auto left = std::ranges::find_if(
            feeds, [](const Feed& feed) { return is_open(*feed.to) && (feed.input->takes & kinds::number); });
        if (left == feeds.end()) return;
        decide(*left->to, value::number);
    }
}

}  // namespace tactus::compile
