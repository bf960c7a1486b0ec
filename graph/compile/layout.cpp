// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/layout.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tactus::compile {

namespace {

/// Last reader, as a position in the order of the group, of every output; or that its place is its own for good.
struct Life {
    static constexpr int for_good = -1;
    int last = for_good;
};

/// Index of each node in its group. Nodes of a cycle come last in it, because they run several times per call.
std::vector<int> last_places_of(const Schedule& plan) {
    std::vector<int> place(plan.nodes.size());
    for (const ScheduleGroup& group : plan.groups) {
        for (std::size_t i = 0; i < group.order.size(); ++i)
            place[static_cast<std::size_t>(group.order[i])] = static_cast<int>(i);
        for (const ScheduleCycle& cycle : group.cycles)
            for (int i = cycle.first; i < cycle.first + cycle.count; ++i)
                place[static_cast<std::size_t>(group.order[static_cast<std::size_t>(i)])] =
                    cycle.first + cycle.count - 1;
    }
    return place;
}

std::vector<std::vector<Life>> lives_of(const Schedule& plan) {
    const std::vector<int> place = last_places_of(plan);
    std::vector<std::vector<Life>> lives;
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        auto& of_node = lives.emplace_back();
        for (const ScheduleOutput& output : plan.nodes[n].outputs)
            of_node.push_back({output.port->type == &value::signal ? place[n] : Life::for_good});
    }
    for (const ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        Life& life = lives[from][static_cast<std::size_t>(wire.from_output)];
        if (life.last == Life::for_good) continue;
        // What leaves the group, or waits for a later tick, is read after the steps.
        const bool stays = plan.nodes[from].group == plan.nodes[to].group && wire.mode != patch::WireMode::delay;
        life.last = stays ? std::max(life.last, place[to]) : Life::for_good;
    }
    return lives;
}

class Placer {
public:
    std::size_t place(std::size_t size) {
        const std::size_t alignment = std::clamp<std::size_t>(std::bit_ceil(size), 8, value_alignment);
        bytes_ = (bytes_ + alignment - 1) / alignment * alignment;
        return std::exchange(bytes_, bytes_ + size);
    }
    /// Groups run on different threads: they share no cache line.
    void close_group() { bytes_ = (bytes_ + value_alignment - 1) / value_alignment * value_alignment; }
    std::size_t bytes() const { return bytes_; }

private:
    std::size_t bytes_ = 0;
};

}  // namespace

ValueLayout lay_out_values(const Schedule& plan, std::span<const int> frames) {
    const auto lives = lives_of(plan);
    ValueLayout layout;
    for (const ScheduleNode& node : plan.nodes) layout.offsets.emplace_back(node.outputs.size());
    Placer placer;
    for (std::size_t g = 0; g < plan.groups.size(); ++g) {
        const ScheduleGroup& group = plan.groups[g];
        const auto count = static_cast<std::size_t>(group.has_audio ? frames[g] : 1);
        std::vector<std::size_t> released;                                  // places to give again
        std::vector<std::vector<std::size_t>> ending(group.order.size());  // places whose last reader is that step
        for (std::size_t at = 0; at < group.order.size(); ++at) {
            const auto n = static_cast<std::size_t>(group.order[at]);
            for (std::size_t k = 0; k < plan.nodes[n].outputs.size(); ++k) {
                std::size_t& offset = layout.offsets[n][k];
                const Life life = lives[n][k];
                if (life.last != Life::for_good && !released.empty()) {
                    offset = released.back();
                    released.pop_back();
                } else offset = placer.place(count * plan.nodes[n].outputs[k].port->type->size);
                if (life.last != Life::for_good) ending[static_cast<std::size_t>(life.last)].push_back(offset);
            }
            released.insert(released.end(), ending[at].begin(), ending[at].end());
        }
        placer.close_group();
    }
    layout.bytes = placer.bytes();
    return layout;
}

}  // namespace tactus::compile
