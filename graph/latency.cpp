// SPDX-License-Identifier: Apache-2.0
#include "graph/latency.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace tactus {

Flicks worst_age(const PlanGroup& producer, const PlanGroup& consumer, const PlanWire& wire) {
    // j·Pc − L runs through every multiple of the common divisor modulo Pp, so the oldest value has waited
    // Pp − gcd on top of the latency, plus what L itself is off that grid.
    const Flicks latency = wire_latency(producer, wire);
    const Flicks step = std::gcd(producer.period, consumer.period);
    const Flicks offset = ((-latency) % step + step) % step;
    return latency + producer.period - step + offset;
}

Ages ages_from(const Plan& plan, int source) {
    Ages ages{std::vector<Flicks>(plan.nodes.size(), unreached), std::vector<int>(plan.nodes.size(), -1)};
    ages.age[static_cast<std::size_t>(source)] = 0;
    // Ages only fall, by Bellman and Ford: a round per node at most.
    for (bool changed = true; changed;) {
        changed = false;
        for (const PlanWire& wire : plan.wires) {
            if (wire.from_node < 0) continue;
            const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
            if (ages.age[from] == unreached) continue;
            const PlanGroup& producer = plan.groups[static_cast<std::size_t>(plan.nodes[from].group)];
            const PlanGroup& consumer = plan.groups[static_cast<std::size_t>(plan.nodes[to].group)];
            const Flicks more =
                &producer != &consumer ? worst_age(producer, consumer, wire) : wire.delay * producer.period;
            if (ages.age[from] + more >= ages.age[to]) continue;
            ages.age[to] = ages.age[from] + more;
            ages.before[to] = wire.from_node;
            changed = true;
        }
    }
    return ages;
}

std::vector<PathLatency> path_latencies(const Plan& plan) {
    const auto is_sink = [](const PlanNode& n) {
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

}  // namespace tactus
