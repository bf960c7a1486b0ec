// SPDX-License-Identifier: Apache-2.0
// The clocks that an engine and a device's process share.
#pragma once

#include <time.h>

#include <cstdint>

namespace tactus::hosted {

inline std::int64_t clock_ns(clockid_t clock) noexcept {
    timespec t;
    ::clock_gettime(clock, &t);
    return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

/// Goes on while the machine is suspended: a force from before is old afterwards. Wait-free where the kernel maps the
/// clock into the process.
inline std::int64_t boot_ns() noexcept { return clock_ns(CLOCK_BOOTTIME); }

/// Stands still while the machine is suspended: nobody was silent meanwhile.
inline std::int64_t steady_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }

inline void sleep_until(std::int64_t steady) noexcept {
    const timespec t{steady / 1'000'000'000, steady % 1'000'000'000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace tactus::hosted
