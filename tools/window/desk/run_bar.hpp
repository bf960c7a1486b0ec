// SPDX-License-Identifier: Apache-2.0
// The toolbar: run, pause, record, undo, save, and the time.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/painter.hpp"

#include <functional>

namespace tactus::window {

class TakeBench;

/// What undo, redo and save mean: the patch, or the plan that was opened.
struct EditButtons {
    bool can_undo = false, can_redo = false, is_saved = true;
    std::function<void()> undo, redo, save;
};
/// `status`: of the run, or of the last one. `take`: null for a run.
void run_bar(Workbench& bench, const RunStatus& status, TakeBench* take, const EditButtons& edits, const Fonts& fonts);
/// Opens the history of faults with the next picture.
void show_faults(Workbench& bench);

}  // namespace tactus::window
