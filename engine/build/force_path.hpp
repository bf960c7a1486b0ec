// SPDX-License-Identifier: Apache-2.0
// Dependence of the force on a hand on nodes and groups, for deadlines and for edits.
#pragma once

#include "engine/build/generation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::build {

/// Returns how the force on a device depends on each node, in the order of generation.nodes.
std::vector<compile::Dependence> dependence_of(const Generation& generation, const io::DeviceSlot& slot);

/// Returns the sources of a device's force: first the other groups on whose values it depends, force values before
/// world values, then the wires between groups that lead to the force, one entry per link. A force value may be late by
/// 3 ms or by one period of its group, whichever is longer; a world value by 1 s. From this call on the links check
/// their values, which must be finite.
std::vector<ValueSource> sources_of(const Generation& generation, const io::DeviceSlot& slot);

/// Returns the time from the first activation of all groups until computed values reach the force on a device. Before
/// that, wires from other groups and delayed wires deliver values that no node has computed, such as a zero wrench
/// while the hand is deep inside a body. Snapshots do not count, because `prepare` sets them.
Flicks warm_up_of(const Generation& generation, const io::DeviceSlot& slot);

/// Returns, in the order of generation.nodes, which nodes influence a force on a hand, in any group. Motors of grippers
/// do not count: their controllers limit the rate of change.
std::vector<bool> nodes_of_forces(const Generation& generation);

/// Hashes everything on which the force on a device depends, except ramped parameters and user requests: nodes with
/// their structure and discrete parameters, groups with their periods and latencies, wires, and the content of files.
std::uint64_t hash_of_force_path(const Generation& generation, const io::DeviceSlot& slot);

/// Returns the devices whose force may jump when `now` takes over: the hash of the force path differs, a node on it
/// with an unchanged description was prepared again, or no node drives the device any more. Requires `survived` and
/// `force_paths`.
std::vector<const io::DeviceSlot*> changed_forces(const Generation& before, const Generation& now);

/// Times after which a change of a node has reached the forces that depend on it.
struct Reach {
    Flicks device_period = 0;  ///< of the slowest device
    Flicks latency = 0;  ///< of all groups in between
};
/// Returns nothing if no force depends on the node.
std::optional<Reach> reach_of(const Generation& generation, std::size_t node);

}  // namespace tactus::build
