// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/latency.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace tactus::analyse {

Flicks worst_age(const compile::ScheduleGroup& producer, const compile::ScheduleGroup& consumer,
                 const compile::ScheduleWire& wire) {
    // j·Pc − L runs through every multiple of the common divisor modulo Pp, so the oldest value has waited
    // Pp − gcd on top of the latency, plus what L itself is off that grid.
    const Flicks latency = compile::wire_latency(producer, wire);
    const Flicks step = std::gcd(producer.period, consumer.period);
    const Flicks offset = ((-latency) % step + step) % step;
    return latency + producer.period - step + offset;
}

namespace {

/// What a wire adds to the age of a value.
Flicks added_age(const compile::Schedule& plan, const compile::ScheduleWire& wire) {
    const compile::ScheduleGroup& producer =
        plan.groups[static_cast<std::size_t>(plan.nodes[static_cast<std::size_t>(wire.from_node)].group)];
    const compile::ScheduleGroup& consumer =
        plan.groups[static_cast<std::size_t>(plan.nodes[static_cast<std::size_t>(wire.to_node)].group)];
    return &producer != &consumer ? worst_age(producer, consumer, wire) : wire.delay * producer.period;
}

}  // namespace

Ages ages_from(const compile::Schedule& plan, int source) {
    Ages ages{std::vector<Flicks>(plan.nodes.size(), unreached), std::vector<int>(plan.nodes.size(), -1)};
    std::vector<std::vector<std::size_t>> leaving(plan.nodes.size());
    for (std::size_t w = 0; w < plan.wires.size(); ++w)
        if (plan.wires[w].from_node >= 0) leaving[static_cast<std::size_t>(plan.wires[w].from_node)].push_back(w);
    // Bellman and Ford: ages only fall. A round visits all wires in their order, which decides between paths of
    // one age; only those are visited behind which an age fell.
    using Visit = std::pair<std::size_t, std::size_t>;  // round, wire
    std::priority_queue<Visit, std::vector<Visit>, std::greater<>> due;
    std::vector<bool> is_due(plan.wires.size());
    const auto fell = [&](std::size_t node, std::size_t round, std::size_t by) {
        for (const std::size_t w : leaving[node]) {
            if (is_due[w]) continue;
            is_due[w] = true;
            due.emplace(w > by ? round : round + 1, w);
        }
    };
    ages.age[static_cast<std::size_t>(source)] = 0;
    fell(static_cast<std::size_t>(source), 0, plan.wires.size());
    while (!due.empty()) {
        const auto [round, w] = due.top();
        due.pop();
        is_due[w] = false;
        const compile::ScheduleWire& wire = plan.wires[w];
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        const Flicks age = ages.age[from] + added_age(plan, wire);
        if (age >= ages.age[to]) continue;
        ages.age[to] = age;
        ages.before[to] = wire.from_node;
        fell(to, round, w);
    }
    return ages;
}

std::vector<Flicks> ages_to(const compile::Schedule& plan, int sink) {
    std::vector<std::vector<const compile::ScheduleWire*>> entering(plan.nodes.size());
    for (const compile::ScheduleWire& wire : plan.wires)
        if (wire.from_node >= 0) entering[static_cast<std::size_t>(wire.to_node)].push_back(&wire);
    std::vector<Flicks> ages(plan.nodes.size(), unreached);
    ages[static_cast<std::size_t>(sink)] = 0;
    // Dijkstra: no wire makes a value younger.
    using Reached = std::pair<Flicks, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    next.emplace(0, sink);
    while (!next.empty()) {
        const auto [age, node] = next.top();
        next.pop();
        if (age > ages[static_cast<std::size_t>(node)]) continue;
        for (const compile::ScheduleWire* wire : entering[static_cast<std::size_t>(node)]) {
            const Flicks longer = age + added_age(plan, *wire);
            Flicks& known = ages[static_cast<std::size_t>(wire->from_node)];
            if (longer >= known) continue;
            known = longer;
            next.emplace(longer, wire->from_node);
        }
    }
    return ages;
}

std::vector<PathLatency> path_latencies(const compile::Schedule& plan) {
    const auto is_sink = [](const compile::ScheduleNode& n) {
        return n.type->role == NodeRole::hand_sink || n.type->role == NodeRole::sound_sink ||
               n.type->role == NodeRole::file_sink;
    };
    std::vector<PathLatency> paths;
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        const Ages ages = ages_from(plan, static_cast<int>(source));
        for (std::size_t sink = 0; sink < plan.nodes.size(); ++sink) {
            if (ages.age[sink] == unreached || !is_sink(plan.nodes[sink])) continue;
            PathLatency path{plan.nodes[source].name, plan.nodes[sink].name, seconds(ages.age[sink]) * 1e3, {}};
            for (int node = static_cast<int>(sink); node >= 0; node = ages.before[static_cast<std::size_t>(node)])
                path.via.push_back(plan.nodes[static_cast<std::size_t>(node)].name);
            std::ranges::reverse(path.via);
            paths.push_back(std::move(path));
        }
    }
    std::ranges::sort(paths, [](const PathLatency& a, const PathLatency& b) {
        return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
    return paths;
}

}  // namespace tactus::analyse
