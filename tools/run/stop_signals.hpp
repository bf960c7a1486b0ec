// SPDX-License-Identifier: Apache-2.0
// Handling of signals: those that end a run in an orderly way, and those that must not end it.
#pragma once

#include <atomic>

namespace tactus::run {

/// Installs handlers: SIGINT, SIGTERM and SIGHUP set the flag; SIGPIPE is ignored, so that writing to a closed pipe is
/// an ordinary error. A SIGHUP that was ignored stays ignored (nohup).
const std::atomic<bool>& stop_on_signals();

}  // namespace tactus::run
