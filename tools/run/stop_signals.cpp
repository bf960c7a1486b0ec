// SPDX-License-Identifier: Apache-2.0
#include "tools/run/stop_signals.hpp"

#include <csignal>

namespace tactus::run {

namespace {

std::atomic<bool> stopped{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void stop(int) { stopped = true; }

}  // namespace

const std::atomic<bool>& stop_on_signals() {
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    if (std::signal(SIGHUP, stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    return stopped;
}

}  // namespace tactus::run
