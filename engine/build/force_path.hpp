// SPDX-License-Identifier: Apache-2.0
// What a force on a hand depends on, whether it is overdue, and whether an edit touches it.
#pragma once

#include "engine/build/generation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::build {

/// How the force on a device depends on each node, in the order of generation.nodes.
std::vector<compile::Dependence> dependence_of(const Generation& generation, const DeviceSlot& slot);

/// The other groups on whose values the force on a device depends, those of force first. A value of force may be late by
/// 3 ms, or by one period of its group if that is longer; one of the world by 1 s. Then the wires between groups that lead
/// to the force, one source for each link, which checks them from then on: they may bring no value that is not finite.
std::vector<ValueSource> sources_of(const Generation& generation, const DeviceSlot& slot);

/// From the first activation of all groups until what they computed has reached the force on a device. Before, wires from
/// other groups and delayed wires bring values that no node has computed: a wrench of zero from a group in which the hand is
/// deep inside of a body. Snapshots do not count: `prepare` has set them.
Flicks warm_up_of(const Generation& generation, const DeviceSlot& slot);

/// Nodes from which values reach a force on a hand, in any group, in the order of generation.nodes. Motors of grippers do
/// not count: their controllers limit how fast an object changes.
std::vector<bool> nodes_of_forces(const Generation& generation);

/// A hash of all on which the force on a device depends but parameters that ramp and requests of the user: nodes with
/// their structure and discrete parameters, groups with their periods and latencies, wires, and the content of files.
std::uint64_t hash_of_force_path(const Generation& generation, const DeviceSlot& slot);

/// The devices whose force may jump when `now` takes over: the hash of its path differs, a node of it was prepared anew
/// although it is described as before, or no node drives the device any more. `survived` and `force_paths` must be known.
std::vector<const DeviceSlot*> changed_forces(const Generation& before, const Generation& now);

/// When a change of a node has reached the forces that depend on it.
struct Reach {
    Flicks device_period = 0;  ///< of the slowest device
    Flicks latency = 0;  ///< of all groups in between
};
/// Nothing when no force depends on the node.
std::optional<Reach> reach_of(const Generation& generation, std::size_t node);

}  // namespace tactus::build
