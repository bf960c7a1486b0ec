// SPDX-License-Identifier: Apache-2.0
// The steady clock, as the threads of a live run read it.
#pragma once

#include <cstdint>

#include <errno.h>
#include <time.h>

namespace tactus::run {

/// Wait-free where the kernel maps the clock into the process.
inline std::int64_t steady_ns() noexcept {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

/// Processor time of the calling thread. Calls the system.
inline std::int64_t thread_ns() noexcept {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

/// Signals do not end it.
inline void sleep_until(std::int64_t when_ns) noexcept {
    const timespec t{when_ns / 1'000'000'000, when_ns % 1'000'000'000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
}

}  // namespace tactus::run
