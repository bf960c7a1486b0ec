// SPDX-License-Identifier: Apache-2.0
// What a force on a hand depends on, and whether an edit touches it.
#pragma once

#include "engine/build/generation.hpp"

namespace tactus::build {

/// Nodes or wires from which values reach a driven device come, go or are made anew. `now.survived` must be known.
bool changes_force_path(const Generation& before, const Generation& now);

}  // namespace tactus::build
