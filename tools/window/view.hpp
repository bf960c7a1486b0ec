// SPDX-License-Identifier: Apache-2.0
// The window on a run or a take.
#pragma once

#include "tools/window/view_choice.hpp"

#include <atomic>

namespace tactus::window {

/// Runs a patch with a window. Ends when the window is closed, or with the run if that continues. Throws Error when no
/// window can be opened.
int view_run(const ViewedRunChoice& choice, const std::atomic<bool>& interrupted);

/// The same, and prints nothing: for measurements. Throws Error also when the run fails.
void watch_run(const ViewedRunChoice& choice, const std::atomic<bool>& interrupted);

/// Opens a window on a take or a patch, which is not run; without a file, on the start page. Throws Error.
int view_file(const FileViewChoice& choice, const std::atomic<bool>& interrupted);

}  // namespace tactus::window
