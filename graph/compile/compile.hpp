// SPDX-License-Identifier: Apache-2.0
// The passes of the compiler, in the order in which compile() runs them. Each reads and extends the plan.
#pragma once

#include "graph/compile/plan.hpp"

namespace tactus::compile {

/// Makes every node and sets its parameters from the patch.
void resolve_nodes(Plan& plan, Catalogue catalogue, patch::Problems& problems);

/// Collects nodes of one rate, or of one named group, into groups, and says which groups carry audio.
void form_groups(Plan& plan, patch::Problems& problems);

/// Finds both ends of every wire and checks types, modes and that each input is fed once.
void resolve_wires(Plan& plan, patch::Problems& problems);

/// Puts the nodes of each group in topological order, ties by name. A cycle is a problem that prints its path.
void order_nodes(Plan& plan, patch::Problems& problems);

/// In audio groups with delayed wires: orders nodes so that the source of a delayed wire runs before its target, and
/// finds the cycles, in which that cannot be. A plan without problems only.
void order_feedback(Plan& plan);

}  // namespace tactus::compile
