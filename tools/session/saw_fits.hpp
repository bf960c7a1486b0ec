// SPDX-License-Identifier: Apache-2.0
// A blade's size stands in several places of a patch and its task: they must agree.
#pragma once

#include "graph/compile/plan.hpp"

namespace tactus::session {

/// Adds a problem where `carve` removes a narrower kerf than a saw or burr cuts, where `kerf_heat` has another stroke
/// than the saw, where a task is for another blade, and where the bone of a task is too coarse for the kerf: `carve`
/// would resample it at a site of its own, which scores cannot compare. Tasks count once their files are loaded.
void check_saw(const compile::Plan& plan, patch::Problems& problems);

}  // namespace tactus::session
