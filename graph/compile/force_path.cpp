// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/force_path.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

namespace tactus::compile {

namespace {

/// What passes this wire is of the world, whatever it is needed for.
bool is_of_world(const Schedule& plan, const ScheduleWire& wire) {
    if (wire.to_input < 0) return true;
    const Input& input =
        *plan.nodes[static_cast<std::size_t>(wire.to_node)].inputs[static_cast<std::size_t>(wire.to_input)].port;
    return input.is_of_world || (input.type && input.type->version);
}

bool drives_device(const ScheduleNode& node) {
    return node.type->role == NodeRole::hand_sink || node.type->role == NodeRole::motor_sink;
}

}  // namespace

std::vector<Dependence> dependence_on(const Schedule& plan, std::span<const int> sinks) {
    std::vector<Dependence> dependence(plan.nodes.size(), Dependence::none);
    std::vector<std::vector<const ScheduleWire*>> into(plan.nodes.size());
    for (const ScheduleWire& wire : plan.wires)
        if (wire.from_node >= 0) into[static_cast<std::size_t>(wire.to_node)].push_back(&wire);
    std::vector<std::size_t> to_visit;
    const auto raise = [&](int node, Dependence to) {
        Dependence& now = dependence[static_cast<std::size_t>(node)];
        if (now >= to) return;
        now = to;
        to_visit.push_back(static_cast<std::size_t>(node));
    };
    for (const int sink : sinks) raise(sink, Dependence::force);
    while (!to_visit.empty()) {
        const std::size_t node = to_visit.back();
        to_visit.pop_back();
        for (const ScheduleWire* wire : into[node])
            raise(wire->from_node, is_of_world(plan, *wire) ? Dependence::world : dependence[node]);
    }
    return dependence;
}

void rank_groups(Schedule& plan) {
    std::vector<int> sinks;
    for (std::size_t n = 0; n < plan.nodes.size(); ++n)
        if (drives_device(plan.nodes[n])) sinks.push_back(static_cast<int>(n));
    const std::vector<Dependence> dependence = dependence_on(plan, sinks);
    for (ScheduleGroup& group : plan.groups)
        group.criticality = group.has_audio ? Criticality::sound : Criticality::other;
    const auto raise = [&plan](std::size_t node, Criticality to) {
        ScheduleGroup& group = plan.groups[static_cast<std::size_t>(plan.nodes[node].group)];
        group.criticality = std::min(group.criticality, to);
    };
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        if (drives_device(plan.nodes[n])) raise(n, Criticality::force_output);
        else if (dependence[n] == Dependence::force) raise(n, Criticality::force_value);
        else if (dependence[n] == Dependence::world) raise(n, Criticality::world_value);
    }
    for (ScheduleGroup& group : plan.groups)
        if (group.criticality <= Criticality::force_value && !group.backlog_given)
            group.backlog = static_cast<int>(call_period(plan, group) / group.period) - 1;
}

std::vector<int> by_priority(const Schedule& plan) {
    std::vector<int> order(plan.groups.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&plan](int g) {
        const ScheduleGroup& group = plan.groups[static_cast<std::size_t>(g)];
        return std::tuple(group.criticality, call_period(plan, group), std::string_view(group.name));
    });
    return order;
}

}  // namespace tactus::compile
