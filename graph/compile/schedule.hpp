// SPDX-License-Identifier: Apache-2.0
// The compiled form of a patch: nodes in groups, their execution order, and the delivery of every wire.
#pragma once

#include "graph/node/node.hpp"
#include "graph/patch/patch.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::compile {

/// Owns one node of any type.
using NodeInstance = std::unique_ptr<void, void (*)(void*)>;

struct ScheduleInput {
    std::string name;
    Input* port = nullptr;
    SourceLocation where;
};
struct ScheduleOutput {
    std::string name;
    Output* port = nullptr;
};

struct ScheduleNode {
    std::string name;
    const NodeType* type = nullptr;
    NodeInstance instance{nullptr, nullptr};
    SourceLocation where;
    int group = -1;
    std::vector<ScheduleInput> inputs;
    std::vector<ScheduleOutput> outputs;
    std::map<std::string, Param*> params;
    std::map<std::string, const Text*> texts;
    std::vector<AssetParam*> assets;
    bool takes_blocks = false;  ///< processes several activations in one call
};

/// A resolved wire to an input or a parameter of a node.
struct ScheduleWire {
    int from_node = -1, from_output = -1;  ///< from_node −1: the asset named `asset`
    int to_node = -1, to_input = -1;       ///< to_input −1: the wire drives `param`
    Param* param = nullptr;
    std::string asset;
    patch::WireMode mode = patch::WireMode::hold;
    int delay = 0;  ///< activations of the producer
    SourceLocation where;
};

/// Nodes of an audio group that feed each other through delayed wires. They are adjacent in the execution order.
struct ScheduleCycle {
    int first = 0, count = 0;  ///< positions in the order of the group
    int longest = 1;           ///< largest number of activations per call: the shortest delay within the cycle
};

/// How a force depends on a node's values.
enum class Dependence : std::uint8_t {
    none,   ///< not at all
    world,  ///< the force stays passive when the values are old
    force,  ///< the values must be fresh
};

/// Purpose of a group; smaller values have higher priority in a live run. Hand forces come before sound: a skipped
/// audio tick is audible, but a skipped force tick can throw the hand.
enum class Criticality : std::uint8_t {
    force_output,  ///< it sends a force to a device
    force_value,   ///< a force depends on its fresh values
    sound,
    world_value,   ///< a force depends on its values, which may be old
    other,
};

struct ScheduleGroup {
    std::string name;
    Flicks period = 0, latency = 0;
    int backlog = 0;
    bool has_audio = false;   ///< some node has a signal port: calls may run several activations
    std::vector<int> order;   ///< nodes, in the order they run
    std::vector<ScheduleCycle> cycles;  ///< audio groups only; in the order of their positions
    bool backlog_given = false;
    Criticality criticality = Criticality::other;
};

struct Schedule {
    patch::Patch patch;
    std::vector<ScheduleNode> nodes;
    std::vector<ScheduleWire> wires;
    std::vector<ScheduleGroup> groups;  ///< shortest period first, ties by name
};

/// Time between two calls of a group in a live run: an audio group is called once per quantum.
constexpr Flicks call_period(const Schedule& plan, const ScheduleGroup& group) {
    return group.has_audio ? std::max(group.period, plan.patch.quantum) : group.period;
}

/// The node types a patch may use.
using Catalogue = std::span<const NodeType* const>;

/// Compiles a patch: resolves nodes and ports, forms groups and orders them. Nodes are created and their parameters
/// set, but none is prepared. Returns nothing if there are problems.
std::optional<Schedule> compile(patch::Patch patch, Catalogue catalogue, patch::Problems& problems);

/// Index of the producer's value that consumer activation `j` reads: floor((j·Pc − L)/Pp); negative: the initial value.
constexpr std::int64_t source_index(std::int64_t j, Flicks consumer_period, Flicks latency, Flicks producer_period) {
    return floor_div(j * consumer_period - latency, producer_period);
}

/// Latency of a wire between two groups: the producer's, plus the declared delay.
constexpr Flicks wire_latency(const ScheduleGroup& producer, const ScheduleWire& wire) {
    return producer.latency + wire.delay * producer.period;
}

}  // namespace tactus::compile
