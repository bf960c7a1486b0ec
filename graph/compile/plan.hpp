// SPDX-License-Identifier: Apache-2.0
// What a patch compiles to: nodes in groups, in the order they run, and how every wire delivers its values.
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

struct PlanInput {
    std::string name;
    Input* port = nullptr;
    SourceLocation where;
};
struct PlanOutput {
    std::string name;
    Output* port = nullptr;
};

struct PlanNode {
    std::string name;
    const NodeType* type = nullptr;
    NodeInstance instance{nullptr, nullptr};
    SourceLocation where;
    int group = -1;
    std::vector<PlanInput> inputs;
    std::vector<PlanOutput> outputs;
    std::map<std::string, Param*> params;
    std::map<std::string, const Text*> texts;
    std::vector<AssetParam*> assets;
    bool takes_blocks = false;  ///< processes several activations in one call
};

/// How a wire delivers: to an input or to a parameter of a node.
struct PlanWire {
    int from_node = -1, from_output = -1;  ///< from_node −1: the asset named `asset`
    int to_node = -1, to_input = -1;       ///< to_input −1: it drives `param`
    Param* param = nullptr;
    std::string asset;
    patch::WireMode mode = patch::WireMode::hold;
    int delay = 0;  ///< activations of the producer
    SourceLocation where;
};

/// Nodes of an audio group that feed each other through delayed wires. They stand next to each other in the order.
struct PlanCycle {
    int first = 0, count = 0;  ///< positions in the order of the group
    int longest = 1;           ///< most activations at a time: the shortest delay within
};

/// How a force depends on a node.
enum class Dependence : std::uint8_t {
    none,   ///< not at all
    world,  ///< it stays passive when the node's values are old
    force,  ///< the node's values must be fresh
};

/// What a group is there for; the smaller, the higher its priority in a live run. A hand comes before sound: a tick that
/// is left out can be heard in one and throws the other.
enum class Criticality : std::uint8_t {
    force_output,  ///< it sends a force to a device
    force_value,   ///< a force depends on fresh values of it
    sound,
    world_value,   ///< a force depends on values of it that may be old
    other,
};

struct PlanGroup {
    std::string name;
    Flicks period = 0, latency = 0;
    int backlog = 0;
    bool has_audio = false;   ///< some node has a signal port: calls may run several activations
    std::vector<int> order;   ///< nodes, in the order they run
    std::vector<PlanCycle> cycles;  ///< audio groups only; in the order of their positions
    bool backlog_given = false;
    Criticality criticality = Criticality::other;
};

struct Plan {
    patch::Patch patch;
    std::vector<PlanNode> nodes;
    std::vector<PlanWire> wires;
    std::vector<PlanGroup> groups;  ///< fastest first, ties by name
};

/// Time between two calls of a group in a live run: an audio group is called once per quantum.
constexpr Flicks call_period(const Plan& plan, const PlanGroup& group) {
    return group.has_audio ? std::max(group.period, plan.patch.quantum) : group.period;
}

/// The node types a patch may use.
using Catalogue = std::span<const NodeType* const>;

/// Compiles a patch: names to nodes and ports, groups, order. Nodes are made and their parameters set, none is prepared.
/// Returns nothing when there are problems.
std::optional<Plan> compile(patch::Patch patch, Catalogue catalogue, patch::Problems& problems);

/// Index of the producer's value that consumer activation `j` reads: floor((j·Pc − L)/Pp); negative: the initial value.
constexpr std::int64_t source_index(std::int64_t j, Flicks consumer_period, Flicks latency, Flicks producer_period) {
    return floor_div(j * consumer_period - latency, producer_period);
}

/// Latency of a wire between two groups: the producer's, plus the declared delay.
constexpr Flicks wire_latency(const PlanGroup& producer, const PlanWire& wire) {
    return producer.latency + wire.delay * producer.period;
}

}  // namespace tactus::compile
