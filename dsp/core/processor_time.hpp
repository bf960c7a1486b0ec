// SPDX-License-Identifier: Apache-2.0
// Processor time, for what is reported and measured. Calls the system: not for a tick.
#pragma once

#include <time.h>

namespace tactus {

inline double seconds_of_clock(clockid_t clock) noexcept {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of all threads of this process, s.
inline double process_seconds() noexcept { return seconds_of_clock(CLOCK_PROCESS_CPUTIME_ID); }

/// Of the calling thread, s. Other load on the machine has an effect only through the caches.
inline double thread_seconds() noexcept { return seconds_of_clock(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace tactus
