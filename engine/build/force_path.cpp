// SPDX-License-Identifier: Apache-2.0
#include "engine/build/force_path.hpp"

#include "dsp/core/hash.hpp"
#include "graph/compile/force_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tactus::build {

namespace {

constexpr Flicks longest_lateness = flicks_per_second * 3 / 1000;  // of a value of force; as of a commit
constexpr Flicks oldest_world = flicks_per_second;

bool drives(const LiveNode& node, const io::DeviceSlot& slot) {
    return std::ranges::any_of(node.uses.devices,
                               [&](const auto& use) { return use.first == &slot && use.second == DeviceUse::drive; });
}

/// Nodes from which values reach a device that `counts`, in any group.
template <class Counts>
std::vector<bool> nodes_before(const Generation& generation, const Counts& counts) {
    std::vector<int> sinks;
    for (std::size_t i = 0; i < generation.nodes.size(); ++i)
        if (std::ranges::any_of(generation.nodes[i]->uses.devices,
                                [&](const auto& use) { return use.second == DeviceUse::drive && counts(*use.first); }))
            sinks.push_back(static_cast<int>(i));
    std::vector<bool> on_path;
    for (const compile::Dependence one : compile::dependence_on(generation.plan, sinks))
        on_path.push_back(one != compile::Dependence::none);
    return on_path;
}

/// What node `i` adds to the force: all but parameters that ramp and requests. Assets are in its structure.
std::uint64_t hash_of_node(const Generation& generation, std::size_t i) {
    const LiveNode& node = *generation.nodes[i];
    const compile::ScheduleNode& planned = generation.plan.nodes[i];
    const compile::ScheduleGroup& group = generation.plan.groups[static_cast<std::size_t>(planned.group)];
    Hash hash;
    for (const std::string_view text : {std::string_view(node.name), std::string_view(node.type->name),
                                        std::string_view(node.structure), std::string_view(group.name)})
        hash.add_text(text);
    hash.add_word(static_cast<std::uint64_t>(group.period));
    hash.add_word(static_cast<std::uint64_t>(group.latency));
    for (const auto& [name, param] : planned.params) {
        if (!param->is_discrete || param->is_trigger) continue;
        hash.add_text(name);
        hash.add_word(std::bit_cast<std::uint64_t>(generation.patch_values[i].at(name)));
    }
    return hash.value();
}

std::uint64_t hash_of_wire(const Generation& generation, const compile::ScheduleWire& wire) {
    const compile::ScheduleNode& to = generation.plan.nodes[static_cast<std::size_t>(wire.to_node)];
    Hash hash;
    if (wire.from_node >= 0) {
        const compile::ScheduleNode& from = generation.plan.nodes[static_cast<std::size_t>(wire.from_node)];
        hash.add_text(from.name);
        hash.add_text(from.outputs[static_cast<std::size_t>(wire.from_output)].name);
    } else hash.add_word(generation.constants.at(to.inputs[static_cast<std::size_t>(wire.to_input)].port));
    hash.add_text(to.name);
    if (wire.to_input >= 0) hash.add_text(to.inputs[static_cast<std::size_t>(wire.to_input)].name);
    for (const auto& [name, param] : to.params)
        if (wire.to_input < 0 && param == wire.param) hash.add_text(name);
    hash.add_word(static_cast<std::uint64_t>(wire.mode));
    hash.add_word(static_cast<std::uint64_t>(wire.delay));
    return hash.value();
}

/// The node of a group whose values leave it towards the force, for people; of several the first by name.
std::string name_source(const Generation& generation, const std::vector<compile::Dependence>& dependence, int group,
                        compile::Dependence kind) {
    std::string name;
    for (const compile::ScheduleWire& wire : generation.plan.wires) {
        if (wire.from_node < 0) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        const compile::ScheduleNode& node = generation.plan.nodes[from];
        if (node.group != group || generation.plan.nodes[to].group == group) continue;
        if (dependence[from] != kind || dependence[to] == compile::Dependence::none) continue;
        if (name.empty() || node.name < name) name = node.name;
    }
    const std::string& group_name = generation.plan.groups[static_cast<std::size_t>(group)].name;
    return fmt::format("node '{}' of the group '{}'", name, group_name);
}

std::string name_of(const Generation& generation, std::size_t node) {
    const compile::ScheduleNode& planned = generation.plan.nodes[node];
    return fmt::format("node '{}' of the group '{}'", planned.name,
                       generation.plan.groups[static_cast<std::size_t>(planned.group)].name);
}

/// The links that bring values to nodes on the path. A value that is not finite is known when it is computed, long before
/// a slow group hands it over.
void add_wires(const Generation& generation, const std::vector<compile::Dependence>& dependence,
               std::vector<ValueSource>& sources) {
    std::unordered_map<const Input*, std::size_t> readers;
    std::unordered_map<const Output*, std::size_t> writers;
    for (std::size_t i = 0; i < generation.nodes.size(); ++i) {
        for (const Output* output : generation.nodes[i]->outputs) writers.emplace(output, i);
        if (dependence[i] == compile::Dependence::none) continue;
        for (const Input* input : generation.nodes[i]->inputs) readers.emplace(input, i);
    }
    for (const auto& link : generation.links) {
        ValueSource source{
            .group = link->producer, .fault = control::Fault::unusable_value, .name = {}, .link = link.get()};
        for (std::size_t w = 0; w < link->wires.size(); ++w) {
            const run::LinkWire& wire = link->wires[w];
            if (!wire.target || !readers.contains(wire.target)) continue;
            source.wires |= run::Link::bit_of(w);
            if (source.name.empty()) source.name = name_of(generation, writers.at(wire.source));
        }
        if (source.wires == 0) continue;
        link->watch(source.wires);
        sources.push_back(std::move(source));
    }
}

}  // namespace

std::vector<compile::Dependence> dependence_of(const Generation& generation, const io::DeviceSlot& slot) {
    std::vector<int> sinks;
    for (std::size_t i = 0; i < generation.nodes.size(); ++i)
        if (drives(*generation.nodes[i], slot)) sinks.push_back(static_cast<int>(i));
    return compile::dependence_on(generation.plan, sinks);
}

std::vector<ValueSource> sources_of(const Generation& generation, const io::DeviceSlot& slot) {
    const std::vector<compile::Dependence> dependence = dependence_of(generation, slot);
    std::vector<compile::Dependence> of_group(generation.groups.size(), compile::Dependence::none);
    for (std::size_t i = 0; i < dependence.size(); ++i) {
        compile::Dependence& so_far = of_group[static_cast<std::size_t>(generation.plan.nodes[i].group)];
        so_far = std::max(so_far, dependence[i]);
    }
    std::vector<ValueSource> sources;
    for (const compile::Dependence kind : {compile::Dependence::force, compile::Dependence::world})
        for (std::size_t g = 0; g < of_group.size(); ++g) {
            // A device's own group is watched through its commits.
            if (of_group[g] != kind || generation.groups[g]->index == slot.group) continue;
            const compile::ScheduleGroup& group = generation.plan.groups[g];
            const bool is_force = kind == compile::Dependence::force;
            sources.push_back({.group = generation.groups[g].get(),
                               .latency = group.latency,
                               .limit = is_force
                                            ? std::max(longest_lateness, compile::call_period(generation.plan, group))
                                            : oldest_world,
                               .fault = is_force ? control::Fault::late_value : control::Fault::old_world,
                               .name = name_source(generation, dependence, static_cast<int>(g), kind)});
        }
    add_wires(generation, dependence, sources);
    return sources;
}

Flicks warm_up_of(const Generation& generation, const io::DeviceSlot& slot) {
    const std::vector<compile::Dependence> dependence = dependence_of(generation, slot);
    const compile::Schedule& plan = generation.plan;
    std::vector<Flicks> of_group(plan.groups.size());
    Flicks warm_up = 0;
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || dependence[static_cast<std::size_t>(wire.to_node)] == compile::Dependence::none)
            continue;
        const compile::ScheduleNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
        const ValueType& type = *from.outputs[static_cast<std::size_t>(wire.from_output)].port->type;
        if (type.version || &type == &value::event) continue;
        const auto group = static_cast<std::size_t>(from.group);
        const bool is_within = plan.nodes[static_cast<std::size_t>(wire.to_node)].group == from.group;
        // Several delays, or groups, may lie one behind the other.
        if (is_within) warm_up += wire.delay * plan.groups[group].period;
        else
            of_group[group] =
                std::max(of_group[group], plan.groups[group].period + compile::wire_latency(plan.groups[group], wire));
    }
    for (const Flicks one : of_group) warm_up += one;
    return warm_up;
}

std::vector<bool> nodes_of_forces(const Generation& generation) {
    return nodes_before(generation, [](const io::DeviceSlot& slot) { return slot.port.info.fingers == 0; });
}

std::uint64_t hash_of_force_path(const Generation& generation, const io::DeviceSlot& slot) {
    const std::vector<compile::Dependence> dependence = dependence_of(generation, slot);
    std::vector<std::uint64_t> parts;  // whatever the order in the text
    for (std::size_t i = 0; i < dependence.size(); ++i)
        if (dependence[i] != compile::Dependence::none) parts.push_back(hash_of_node(generation, i));
    for (const compile::ScheduleWire& wire : generation.plan.wires)
        if (dependence[static_cast<std::size_t>(wire.to_node)] != compile::Dependence::none)
            parts.push_back(hash_of_wire(generation, wire));
    std::ranges::sort(parts);
    Hash hash;
    for (const std::uint64_t part : parts) hash.add_word(part);
    return hash.value();
}

std::vector<const io::DeviceSlot*> changed_forces(const Generation& before, const Generation& now) {
    std::vector<const io::DeviceSlot*> changed;
    for (const auto& [slot, hash] : before.force_paths)
        if (!now.force_paths.contains(slot)) changed.push_back(slot);
    for (const auto& [slot, hash] : now.force_paths) {
        const auto old = before.force_paths.find(slot);
        bool is_changed = old == before.force_paths.end() || old->second != hash;
        const std::vector<compile::Dependence> dependence = dependence_of(now, *slot);
        for (std::size_t i = 0; i < dependence.size(); ++i)
            is_changed = is_changed || (dependence[i] != compile::Dependence::none && !now.survived[i]);
        if (is_changed) changed.push_back(slot);
    }
    return changed;
}

std::optional<Reach> reach_of(const Generation& generation, std::size_t node) {
    std::optional<Reach> reach;
    for (const auto& [slot, hash] : generation.force_paths) {
        const std::vector<compile::Dependence> dependence = dependence_of(generation, *slot);
        if (dependence[node] == compile::Dependence::none) continue;
        std::vector<bool> is_on_path(generation.plan.groups.size());
        for (std::size_t i = 0; i < dependence.size(); ++i)
            if (dependence[i] != compile::Dependence::none)
                is_on_path[static_cast<std::size_t>(generation.plan.nodes[i].group)] = true;
        Flicks latency = 0;
        for (std::size_t g = 0; g < is_on_path.size(); ++g)
            if (is_on_path[g]) latency += generation.plan.groups[g].period + generation.plan.groups[g].latency;
        reach = Reach{std::max(reach ? reach->device_period : 0, slot->period),
                      std::max(reach ? reach->latency : 0, latency)};
    }
    return reach;
}

}  // namespace tactus::build
