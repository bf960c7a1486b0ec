// SPDX-License-Identifier: Apache-2.0
#include "engine/build/force_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tactus::build {

namespace {

/// Nodes from which values reach a device that `counts`, in any group.
template <class Counts>
std::vector<bool> nodes_before(const Generation& generation, const Counts& counts) {
    std::vector<bool> on_path;
    for (const auto& node : generation.nodes)
        on_path.push_back(std::ranges::any_of(
            node->uses.devices, [&](const auto& use) { return use.second == DeviceUse::drive && counts(*use.first); }));
    std::vector<std::vector<int>> sources(on_path.size());
    for (const compile::PlanWire& wire : generation.plan.wires)
        if (wire.from_node >= 0) sources[static_cast<std::size_t>(wire.to_node)].push_back(wire.from_node);
    std::vector<std::size_t> to_visit;
    for (std::size_t i = 0; i < on_path.size(); ++i)
        if (on_path[i]) to_visit.push_back(i);
    while (!to_visit.empty()) {
        const std::size_t node = to_visit.back();
        to_visit.pop_back();
        for (const int source : sources[node]) {
            const auto from = static_cast<std::size_t>(source);
            if (on_path[from]) continue;
            on_path[from] = true;
            to_visit.push_back(from);
        }
    }
    return on_path;
}

std::vector<bool> force_path(const Generation& generation) {
    return nodes_before(generation, [](const DeviceSlot&) { return true; });
}

/// The nodes and wires of the force path, as text.
std::vector<std::string> describe_force_path(const Generation& generation) {
    const std::vector<bool> on_path = force_path(generation);
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < generation.nodes.size(); ++i)
        if (on_path[i]) parts.push_back(generation.nodes[i]->name);
    for (const compile::PlanWire& wire : generation.plan.wires) {
        const auto to = static_cast<std::size_t>(wire.to_node);
        if (!on_path[to]) continue;
        std::string from = wire.asset, target;
        if (wire.from_node >= 0) {
            const compile::PlanNode& node = generation.plan.nodes[static_cast<std::size_t>(wire.from_node)];
            from = node.name + "." + node.outputs[static_cast<std::size_t>(wire.from_output)].name;
        }
        for (const auto& [name, param] : generation.plan.nodes[to].params)
            if (wire.to_input < 0 && param == wire.param) target = name;
        parts.push_back(fmt::format("{} {} {} {} {} {}", from, generation.nodes[to]->name, wire.to_input, target,
                                    static_cast<int>(wire.mode), wire.delay));
    }
    std::ranges::sort(parts);
    return parts;
}

}  // namespace

std::vector<bool> nodes_of_forces(const Generation& generation) {
    return nodes_before(generation, [](const DeviceSlot& slot) { return slot.port.info.fingers == 0; });
}

bool changes_force_path(const Generation& before, const Generation& now) {
    const std::vector<bool> on_path = force_path(now);
    for (std::size_t i = 0; i < now.nodes.size(); ++i)
        if (on_path[i] && !now.survived[i]) return true;
    return describe_force_path(before) != describe_force_path(now);
}

}  // namespace tactus::build
