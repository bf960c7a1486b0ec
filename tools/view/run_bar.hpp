// SPDX-License-Identifier: Apache-2.0
// Run, pause, record, undo, save, and where in time the window is.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/workbench.hpp"

namespace tactus::view {

class TakeBench;

/// `take` is null in a run.
void run_bar(Workbench& bench, TakeBench* take, const Fonts& fonts);

}  // namespace tactus::view
