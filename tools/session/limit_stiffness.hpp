// SPDX-License-Identifier: Apache-2.0
// No patch feels stiffer than its device states it can be.
#pragma once

#include "engine/io/host.hpp"
#include "graph/compile/plan.hpp"

namespace tactus::session {

/// For each device that states a `max_stiffness`: the ranges of the stiffness parameters that are felt through it end
/// there, so that wires are clamped and `set` is refused. A value that is larger already is an Error at its place in the
/// patch. Before the plan runs; `host` has its devices open. Devices that state nothing limit nothing.
void limit_stiffness(const compile::Plan& plan, const io::EngineHost& host);

}  // namespace tactus::session
