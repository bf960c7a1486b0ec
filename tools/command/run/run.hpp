// SPDX-License-Identifier: Apache-2.0
// The part of `tactus run` that only a program with a window has.
#pragma once

#include "tools/window/view_choice.hpp"

#include <atomic>

namespace tactus::command {

/// `run --view`; returns the exit code. Each program defines its own: tactus-full opens the window, tactus starts
/// tactus-full.
int run_in_window(const window::ViewedRunChoice& choice, const std::atomic<bool>& interrupted);

}  // namespace tactus::command
