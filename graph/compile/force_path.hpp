// SPDX-License-Identifier: Apache-2.0
// The values on which a force depends: those of force, which must be fresh, and those of the world, which may be old.
#pragma once

#include "graph/compile/plan.hpp"

#include <span>
#include <vector>

namespace tactus::compile {

/// For each node of the plan how the nodes `sinks` depend on what it computes. A path through an input of the world, a
/// snapshot or a parameter is of the world; of several paths to a node the one of force counts.
std::vector<Dependence> dependence_on(const Plan& plan, std::span<const int> sinks);

/// Decides the criticality of all groups. Groups that own or produce a force never run late calls: their backlog is 0, or
/// what is left of the present call of an audio group.
void rank_groups(Plan& plan);

/// The groups in the order of their priority in a live run: by criticality, then the fastest calls first, ties by name.
std::vector<int> by_priority(const Plan& plan);

}  // namespace tactus::compile
