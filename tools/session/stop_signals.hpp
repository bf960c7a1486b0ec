// SPDX-License-Identifier: Apache-2.0
// Signals that ask a run to end in order, and those that must not end it.
#pragma once

#include <atomic>

namespace tactus::session {

/// From now on SIGINT, SIGTERM and SIGHUP set the flag, and writing to a pipe or terminal that is closed is an error that
/// can be passed over. A SIGHUP that was ignored stays ignored (nohup).
const std::atomic<bool>& stop_on_signals();

}  // namespace tactus::session
