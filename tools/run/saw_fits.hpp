// SPDX-License-Identifier: Apache-2.0
// Checks that the sizes of a blade agree that a patch and its task specify in several nodes.
#pragma once

#include "graph/compile/schedule.hpp"

namespace tactus::run {

/// Adds a problem if `carve` removes a narrower kerf than a saw or burr cuts, if `kerf_heat` has another stroke than
/// the saw, if a task specifies another blade, or if the bone of a task is too coarse for the kerf. In the last case
/// `carve` would resample it at a site of its own, so that scores would not be comparable. Tasks are checked once their
/// files are loaded.
void check_saw(const compile::Schedule& plan, patch::Problems& problems);

}  // namespace tactus::run
