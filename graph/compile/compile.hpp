// SPDX-License-Identifier: Apache-2.0
// The passes of the compiler, in the order in which compile() runs them. Each reads and extends the plan.
#pragma once

#include "graph/compile/schedule.hpp"

namespace tactus::compile {

/// Creates every node and sets its parameters from the patch.
void resolve_nodes(Schedule& plan, Catalogue catalogue, patch::Problems& problems);

/// Collects the nodes of one rate, or of one named group, into groups and marks the groups that carry audio.
void form_groups(Schedule& plan, patch::Problems& problems);

/// Resolves both ends of every wire. Checks types and modes, and that each input has one source.
void resolve_wires(Schedule& plan, patch::Problems& problems);

/// Sorts the nodes of each group topologically, ties by name. A cycle is reported as a problem with its path.
void order_nodes(Schedule& plan, patch::Problems& problems);

/// In audio groups with delayed wires, orders nodes so that the source of a delayed wire runs before its target, and
/// records the cycles in which no such order exists. Requires a plan without problems.
void order_feedback(Schedule& plan);

}  // namespace tactus::compile
