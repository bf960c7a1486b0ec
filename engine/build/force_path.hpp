// SPDX-License-Identifier: Apache-2.0
// What a force on a hand depends on, and whether an edit touches it.
#pragma once

#include "engine/build/generation.hpp"

#include <vector>

namespace tactus::build {

/// Nodes from which values reach a force on a hand, in any group, in the order of generation.nodes. Motors of grippers do
/// not count: their controllers limit how fast an object changes.
std::vector<bool> nodes_of_forces(const Generation& generation);

/// True when the edit adds, removes or prepares anew nodes or wires from which values reach a driven device. `now.survived`
/// must be known.
bool changes_force_path(const Generation& before, const Generation& now);

}  // namespace tactus::build
