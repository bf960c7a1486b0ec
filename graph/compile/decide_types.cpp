// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/decide_types.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tactus::compile {

namespace {

bool is_open(const ScheduleNode& node) {
    return std::ranges::any_of(node.outputs, [](const ScheduleOutput& o) { return o.port->type == &value::undecided; });
}

/// A wire into a node whose type is open.
struct Feed {
    const Output* from = nullptr;
    ScheduleNode* to = nullptr;
    const Input* input = nullptr;
};

/// Carries types along the feeds, from node to node.
class Carrier {
public:
    void add(const ScheduleNode& from, const Feed& feed) {
        feeds_[&from].push_back(feed);
        all_.push_back(feed);
    }

    void carry() {
        for (const Feed& feed : all_) take(feed);
        follow();
        // What is left is cycles that no type comes into. They carry numbers, so that they are refused as cycles.
        for (const Feed& feed : all_) {
            if (!is_open(*feed.to) || !(feed.input->takes & kinds::number)) continue;
            decide(*feed.to, value::number);
            follow();
        }
    }

private:
    /// The node's outputs have the type from now on, and its inputs, those without a wire too.
    void decide(ScheduleNode& node, const ValueType& type) {
        for (const ScheduleOutput& output : node.outputs)
            if (output.port->type == &value::undecided) output.port->type = &type;
        for (const ScheduleInput& input : node.inputs)
            if (input.port->kind == InputKind::any) input.port->type = &type;
        decided_.push_back(&node);
    }

    void take(const Feed& feed) {
        const ValueType& type = *feed.from->type;
        if (&type == &value::undecided || !is_open(*feed.to) || !(feed.input->takes & kind_of(type))) return;
        decide(*feed.to, type);
    }

    void follow() {
        while (!decided_.empty()) {
            const ScheduleNode* const node = decided_.back();
            decided_.pop_back();
            if (const auto found = feeds_.find(node); found != feeds_.end())
                for (const Feed& feed : found->second) take(feed);
        }
    }

    std::unordered_map<const ScheduleNode*, std::vector<Feed>> feeds_;  // by the node that they come from
    std::vector<Feed> all_;
    std::vector<const ScheduleNode*> decided_;  // whose feeds are to be followed
};

}  // namespace

void decide_types(Schedule& plan) {
    std::unordered_map<std::string_view, ScheduleNode*> nodes;
    bool some_are_open = false;
    for (ScheduleNode& node : plan.nodes) {
        nodes.emplace(node.name, &node);
        some_are_open |= is_open(node);
    }
    if (!some_are_open) return;
    Carrier carrier;
    for (const patch::PatchWire& wire : plan.patch.wires) {
        const auto from = nodes.find(wire.from_node), to = nodes.find(wire.to_node);
        if (from == nodes.end() || to == nodes.end() || !is_open(*to->second)) continue;
        const auto output = std::ranges::find(from->second->outputs, wire.from_port, &ScheduleOutput::name);
        const auto input = std::ranges::find(to->second->inputs, wire.to_port, &ScheduleInput::name);
        if (output == from->second->outputs.end() || input == to->second->inputs.end()) continue;
        if (input->port->kind == InputKind::any) carrier.add(*from->second, {output->port, to->second, input->port});
    }
    carrier.carry();
}

}  // namespace tactus::compile
