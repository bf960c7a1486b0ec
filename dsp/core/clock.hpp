// SPDX-License-Identifier: Apache-2.0
// The clocks and waits of every thread of a live run. No other code of devices, nodes and engine calls a clock or a
// sleep; a timed wait on a std::condition_variable uses the same steady clock. All of them end in the C library's
// functions, which the test programs define themselves (tests/support/virtual_clock.hpp): the product has no second
// clock and no switch.
#pragma once

#include <cstdint>

#include <errno.h>
#include <time.h>

namespace tactus {

namespace detail {

inline std::int64_t clock_ns(clockid_t clock) noexcept {
    timespec t;
    ::clock_gettime(clock, &t);
    return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

}  // namespace detail

/// ns. Stands still while the machine is suspended. Wait-free where the kernel maps the clock into the process.
inline std::int64_t steady_ns() noexcept { return detail::clock_ns(CLOCK_MONOTONIC); }

/// ns. Advances while the machine is suspended: a force from before is old afterwards. Wait-free like `steady_ns`.
inline std::int64_t boot_ns() noexcept { return detail::clock_ns(CLOCK_BOOTTIME); }

/// Processor time of the calling thread, ns. A system call.
inline std::int64_t thread_ns() noexcept { return detail::clock_ns(CLOCK_THREAD_CPUTIME_ID); }

/// Processor time of another thread of this process, by its clock (`pthread_getcpuclockid`), ns. A system call.
inline std::int64_t thread_ns(clockid_t clock) noexcept { return detail::clock_ns(clock); }

/// Until `steady_ns` is `when_ns`, or later by what the scheduler needs to wake the thread. Signals do not end it.
inline void sleep_until(std::int64_t when_ns) noexcept {
    const timespec t{when_ns / 1'000'000'000, when_ns % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
}

inline void sleep_for(std::int64_t duration_ns) noexcept { sleep_until(steady_ns() + duration_ns); }

/// From now to `when_ns` in whole ms, at least 0: for poll.
inline int ms_until(std::int64_t when_ns) noexcept {
    const std::int64_t left_ns = when_ns - steady_ns();
    return left_ns <= 0 ? 0 : static_cast<int>(left_ns / 1'000'000);
}

/// Sleeps until `spin_ns` before `when_ns` and reads the clock from there on: more exact, at the cost of a processor.
inline void wait_until(std::int64_t when_ns, std::int64_t spin_ns) noexcept {
    if (steady_ns() < when_ns - spin_ns) sleep_until(when_ns - spin_ns);
    while (steady_ns() < when_ns) {
    }
}

}  // namespace tactus
