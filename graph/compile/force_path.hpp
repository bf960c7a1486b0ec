// SPDX-License-Identifier: Apache-2.0
// Dependence of forces on values: force values, which must be fresh, and world values, which may be old.
#pragma once

#include "graph/compile/schedule.hpp"

#include <span>
#include <vector>

namespace tactus::compile {

/// Returns, for each node of the plan, how the nodes `sinks` depend on its values. A path is a world path if it passes
/// through a world input, a snapshot or a parameter. If several paths lead to a node, a force path takes precedence.
std::vector<Dependence> dependence_on(const Schedule& plan, std::span<const int> sinks);

/// Sets the criticality of all groups. Groups that own or produce a force never run late calls: their backlog is 0, or,
/// in an audio group, the rest of the current call.
void rank_groups(Schedule& plan);

/// Returns the groups in the order of their priority in a live run: by criticality, then by call period, ties by name.
std::vector<int> by_priority(const Schedule& plan);

}  // namespace tactus::compile
