// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/compile.hpp"

#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <unordered_map>

namespace tactus::compile {

namespace {

bool has_signal_port(const ScheduleNode& node) {
    const auto is_signal = [](const auto& port) { return port.port->type == &value::signal; };
    return std::ranges::any_of(node.outputs, is_signal) || std::ranges::any_of(node.inputs, is_signal);
}

Flicks parse_latency(const patch::PatchGroup& group, Flicks period) {
    constexpr int max_ticks = 1'000'000;  // as of a delay; 64 MB for a wire of poses
    const double flicks = parse_as(group.latency, "s") * static_cast<double>(flicks_per_second);
    if (!(flicks >= 1.0)) throw Error(fmt::format("a latency must be above zero, got '{}'", group.latency));
    if (flicks > max_ticks * static_cast<double>(period))
        throw Error(
            fmt::format("a latency may be {} ticks of its group at most, here {:g} s, got '{}'; wires keep the "
                        "values of all that time in memory",
                        max_ticks, max_ticks * seconds(period), group.latency));
    return std::llround(flicks);
}

/// Collects groups in the order in which nodes name them first.
class GroupCollector {
public:
    GroupCollector(Schedule& plan, const patch::Problems& problems) : plan_(plan), problems_(problems) {
        for (const patch::PatchGroup& group : plan.patch.groups) declared_.emplace(group.name, &group);
    }

    /// Index of the group that `node` belongs to, made on first use.
    int group_of(const patch::PatchNode& node) {
        ScheduleGroup group = node.group.empty() ? group_of_rate(node.rate) : named(node.group);
        const auto [at, is_new] = made_.try_emplace(group.name, static_cast<int>(plan_.groups.size()));
        if (is_new) plan_.groups.push_back(std::move(group));
        return at->second;
    }

private:
    static ScheduleGroup group_of_rate(const std::string& text) {
        ScheduleGroup group;
        group.period = patch::parse_rate(text);
        const double rate = rate_of(group.period);
        group.name = format_quantity(rate, rate >= 1000.0 ? "kHz" : "Hz");
        return group;
    }

    ScheduleGroup named(const std::string& name) const {
        const auto found = declared_.find(name);
        if (found == declared_.end()) {
            std::vector<std::string> names;
            if (problems_.wants_hint())
                for (const patch::PatchGroup& g : plan_.patch.groups) names.push_back(g.name);
            throw Error(fmt::format("no group '{}' in [groups]{}", name, did_you_mean(name, names)));
        }
        const patch::PatchGroup& declared = *found->second;
        ScheduleGroup group;
        group.name = declared.name;
        group.period = patch::parse_rate(declared.rate);
        if (!declared.latency.empty()) group.latency = parse_latency(declared, group.period);
        group.backlog = declared.backlog;
        group.backlog_given = declared.backlog >= 0;
        return group;
    }

    Schedule& plan_;
    const patch::Problems& problems_;
    std::unordered_map<std::string_view, const patch::PatchGroup*> declared_;
    std::unordered_map<std::string, int> made_;
};

}  // namespace

void form_groups(Schedule& plan, patch::Problems& problems) {
    GroupCollector collector(plan, problems);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        const patch::PatchNode& patch_node = plan.patch.nodes[i];
        try {
            plan.nodes[i].group = collector.group_of(patch_node);
        } catch (const Error& error) {
            problems.add(patch_node.rate_where, error.message());
        }
    }
    std::vector<int> rank(plan.groups.size());
    std::iota(rank.begin(), rank.end(), 0);
    std::ranges::sort(rank, [&](int a, int b) {
        const ScheduleGroup &ga = plan.groups[static_cast<std::size_t>(a)],
                            &gb = plan.groups[static_cast<std::size_t>(b)];
        return ga.period != gb.period ? ga.period < gb.period : ga.name < gb.name;
    });
    std::vector<ScheduleGroup> sorted;
    std::vector<int> place(rank.size());
    for (const int old : rank) {
        place[static_cast<std::size_t>(old)] = static_cast<int>(sorted.size());
        sorted.push_back(std::move(plan.groups[static_cast<std::size_t>(old)]));
    }
    plan.groups = std::move(sorted);
    for (ScheduleNode& node : plan.nodes) {
        if (node.group < 0) continue;
        node.group = place[static_cast<std::size_t>(node.group)];
        if (node.type && has_signal_port(node)) plan.groups[static_cast<std::size_t>(node.group)].has_audio = true;
    }
    // Values live in an audio group for one sample; towards other groups its latency is the patch's quantum.
    for (ScheduleGroup& group : plan.groups) {
        if (group.latency == 0) group.latency = group.has_audio ? plan.patch.quantum : group.period;
        // A tenth of a second of catching up keeps a stalled machine's log short without losing what was cut or played.
        if (!group.backlog_given)
            group.backlog = static_cast<int>(std::max<Flicks>(1, flicks_per_second / 10 / group.period));
    }
}

namespace {

/// Follows unmet dependencies from a node that is on or behind a cycle until one repeats; returns the loop in the order
/// values flow, its first node also at the end.
std::vector<int> find_cycle(const std::vector<int>& left, const std::vector<std::vector<int>>& before) {
    constexpr int placed = -2, unseen = -1;
    std::vector<int> position(before.size(), placed);  // on the path
    for (const int node : left) position[static_cast<std::size_t>(node)] = unseen;
    std::vector<int> path;
    for (int next = left.front();;) {
        int& at = position[static_cast<std::size_t>(next)];
        path.push_back(next);
        if (at != unseen) {
            path.erase(path.begin(), path.begin() + at);
            break;
        }
        at = static_cast<int>(path.size()) - 1;
        next = -1;
        for (const int candidate : before[static_cast<std::size_t>(path.back())])
            if (position[static_cast<std::size_t>(candidate)] != placed && (next < 0 || candidate < next))
                next = candidate;
    }
    std::ranges::reverse(path);
    return path;
}

}  // namespace

void order_nodes(Schedule& plan, patch::Problems& problems) {
    std::vector<std::vector<int>> before(plan.nodes.size()), after(plan.nodes.size());
    for (const ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.mode == patch::WireMode::delay) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        if (plan.nodes[from].group != plan.nodes[to].group) continue;
        before[to].push_back(wire.from_node);
        after[from].push_back(wire.to_node);
    }
    const auto by_name = [&plan](int a, int b) {
        return plan.nodes[static_cast<std::size_t>(a)].name > plan.nodes[static_cast<std::size_t>(b)].name;
    };
    std::vector<int> ready;  // a heap: the smallest name on top
    std::vector<std::size_t> unmet(plan.nodes.size());
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        unmet[i] = before[i].size();
        if (unmet[i] == 0) ready.push_back(static_cast<int>(i));
    }
    std::ranges::make_heap(ready, by_name);
    std::vector<bool> placed(plan.nodes.size());
    while (!ready.empty()) {
        std::ranges::pop_heap(ready, by_name);
        const int node = ready.back();
        ready.pop_back();
        placed[static_cast<std::size_t>(node)] = true;
        plan.groups[static_cast<std::size_t>(plan.nodes[static_cast<std::size_t>(node)].group)].order.push_back(node);
        for (const int next : after[static_cast<std::size_t>(node)])
            if (--unmet[static_cast<std::size_t>(next)] == 0) {
                ready.push_back(next);
                std::ranges::push_heap(ready, by_name);
            }
    }
    std::vector<int> left;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
        if (!placed[i]) left.push_back(static_cast<int>(i));
    if (left.empty()) return;
    const std::vector<int> cycle = find_cycle(left, before);
    std::string text;
    for (const int node : cycle) text += (text.empty() ? "" : " -> ") + plan.nodes[static_cast<std::size_t>(node)].name;
    problems.add(plan.nodes[static_cast<std::size_t>(cycle.front())].where,
                 fmt::format("a cycle without a delay: {}; write 'as delay 1' on one of its wires", text));
}

}  // namespace tactus::compile
