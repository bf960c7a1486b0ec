// SPDX-License-Identifier: Apache-2.0
#include "tests/support/realtime_check.hpp"

#include "tests/support/realtime_counters.hpp"
#include "tests/support/system_call_trap.hpp"

#include <fmt/format.h>

namespace tactus {

std::string RealtimeViolations::describe() const {
    std::string text;
    const auto add = [&](std::int64_t count, const char* one) {
        if (count != 0) text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, one, count == 1 ? "" : "s");
    };
    add(allocations, "allocation");
    add(releases, "release");
    add(locks, "lock");
    add(waits, "wait");
    add(prints, "print");
    add(system_calls, "system call");
    if (system_calls != 0) text += fmt::format(" (last: number {})", system_call);
    return text.empty() ? "none" : text;
}

RealtimeWatch realtime_watch() {
    RealtimeWatch watch;
    watch.locks_and_waits = interposes_locks();
    const bool armed = arm_system_call_trap();
    if (armed) disarm_system_call_trap();
    watch.system_calls = armed;
    if (!watch.locks_and_waits) watch.missing = "ThreadSanitizer: locks, waits and system calls are not watched";
    else if (!armed) watch.missing = "this kernel or processor has no syscall user dispatch: system calls not watched";
    return watch;
}

namespace detail {

Watching::Watching() {
    start_counting();
    armed_ = arm_system_call_trap();
}

Watching::~Watching() {
    if (armed_) disarm_system_call_trap();
}

RealtimeViolations Watching::finish() {
    if (armed_) disarm_system_call_trap();
    armed_ = false;
    return counted();
}

}  // namespace detail
}  // namespace tactus
