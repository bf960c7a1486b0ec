// SPDX-License-Identifier: Apache-2.0
// Feedback in audio groups. A call covers several activations, so the nodes of a cycle must run a few at a time; all
// others run a whole call at once.
#include "graph/compile/compile.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace tactus::compile {

namespace {

/// The nodes of one group by their places in its order, and the wires between them.
struct GroupGraph {
    std::vector<std::vector<int>> after;
    bool has_delays = false;

    std::size_t size() const { return after.size(); }
};

/// Strongly connected components (Tarjan 1972) without recursion: of each node its component. A component's number is
/// larger than those of the components it leads to.
class Components {
public:
    explicit Components(const GroupGraph& graph)
        : of(graph.size(), -1), graph_(graph), index_(graph.size(), -1), low_(graph.size()) {
        for (int node = 0; node < static_cast<int>(graph.size()); ++node)
            if (at(index_, node) < 0) visit(node);
    }

    std::vector<int> of;
    int count = 0;

private:
    static int& at(std::vector<int>& list, int node) { return list[static_cast<std::size_t>(node)]; }

    void enter(int node) {
        at(index_, node) = at(low_, node) = entered_++;
        open_.push_back(node);
        path_.emplace_back(node, 0);
    }

    void visit(int start) {
        enter(start);
        while (!path_.empty()) {
            const int node = path_.back().first;
            const auto& next = graph_.after[static_cast<std::size_t>(node)];
            if (path_.back().second < next.size()) {
                const int to = next[path_.back().second++];
                if (at(index_, to) < 0) enter(to);
                else if (at(of, to) < 0) at(low_, node) = std::min(at(low_, node), at(index_, to));
                continue;
            }
            path_.pop_back();
            if (!path_.empty()) at(low_, path_.back().first) = std::min(at(low_, path_.back().first), at(low_, node));
            if (at(low_, node) == at(index_, node)) close(node);
        }
    }

    void close(int root) {
        int node = -1;
        do {
            node = open_.back();
            open_.pop_back();
            at(of, node) = count;
        } while (node != root);
        ++count;
    }

    const GroupGraph& graph_;
    std::vector<int> index_, low_, open_;
    std::vector<std::pair<int, std::size_t>> path_;  // a node, and how many of its wires were followed
    int entered_ = 0;
};

/// Index of each node in its group.
std::vector<int> places_of(const Schedule& plan) {
    std::vector<int> places(plan.nodes.size());
    for (const ScheduleGroup& group : plan.groups)
        for (std::size_t i = 0; i < group.order.size(); ++i)
            places[static_cast<std::size_t>(group.order[i])] = static_cast<int>(i);
    return places;
}

/// The wires within groups, as places in their orders.
std::vector<GroupGraph> graphs_of(const Schedule& plan, const std::vector<int>& places) {
    std::vector<GroupGraph> graphs(plan.groups.size());
    for (std::size_t g = 0; g < plan.groups.size(); ++g) graphs[g].after.resize(plan.groups[g].order.size());
    for (const ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        const int group = plan.nodes[from].group;
        if (group != plan.nodes[to].group) continue;
        GroupGraph& graph = graphs[static_cast<std::size_t>(group)];
        graph.after[static_cast<std::size_t>(places[from])].push_back(places[to]);
        graph.has_delays = graph.has_delays || wire.mode == patch::WireMode::delay;
    }
    return graphs;
}

/// Topological order of the components; the order of nodes within a component is kept.
std::vector<int> order_of(const Components& components) {
    std::vector<int> order(components.of.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater(),
                             [&](int node) { return components.of[static_cast<std::size_t>(node)]; });
    return order;
}

}  // namespace

void order_feedback(Schedule& plan) {
    const std::vector<int> places = places_of(plan);
    const std::vector<GroupGraph> graphs = graphs_of(plan, places);
    std::vector<int> cycle_of(plan.nodes.size(), -1);
    for (std::size_t g = 0; g < plan.groups.size(); ++g) {
        ScheduleGroup& group = plan.groups[g];
        if (!group.has_audio || !graphs[g].has_delays) continue;
        const Components components(graphs[g]);
        const std::vector<int> nodes = group.order, order = order_of(components);
        for (std::size_t i = 0; i < order.size(); ++i) group.order[i] = nodes[static_cast<std::size_t>(order[i])];
        const auto component_at = [&](std::size_t i) { return components.of[static_cast<std::size_t>(order[i])]; };
        for (std::size_t i = 0, end = 0; i < order.size(); i = end) {
            for (end = i + 1; end < order.size() && component_at(end) == component_at(i);) ++end;
            const auto& next = graphs[g].after[static_cast<std::size_t>(order[i])];
            if (end == i + 1 && std::ranges::find(next, order[i]) == next.end()) continue;
            for (std::size_t k = i; k < end; ++k)
                cycle_of[static_cast<std::size_t>(group.order[k])] = static_cast<int>(group.cycles.size());
            group.cycles.push_back({static_cast<int>(i), static_cast<int>(end - i), std::numeric_limits<int>::max()});
        }
    }
    for (const ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.mode != patch::WireMode::delay) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        const bool same = plan.nodes[from].group == plan.nodes[to].group && cycle_of[from] == cycle_of[to];
        if (!same || cycle_of[from] < 0) continue;
        ScheduleCycle& cycle = plan.groups[static_cast<std::size_t>(plan.nodes[from].group)]
                                   .cycles[static_cast<std::size_t>(cycle_of[from])];
        cycle.longest = std::min(cycle.longest, wire.delay);
    }
}

}  // namespace tactus::compile
