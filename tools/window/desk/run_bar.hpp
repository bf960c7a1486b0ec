// SPDX-License-Identifier: Apache-2.0
// The toolbar: run, pause, record, undo, save, and the time.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

class TakeBench;

/// `status`: of the run, or of the last one. `take`: null for a run.
void run_bar(Workbench& bench, const RunStatus& status, TakeBench* take, const Fonts& fonts);
/// Opens the history of faults with the next picture.
void show_faults(Workbench& bench);

}  // namespace tactus::window
