// SPDX-License-Identifier: Apache-2.0
// The toolbar: run, pause, record, undo, save, and the time.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/workbench.hpp"

namespace tactus::view {

class TakeBench;

/// `take`: null for a run.
void run_bar(Workbench& bench, TakeBench* take, const Fonts& fonts);

}  // namespace tactus::view
