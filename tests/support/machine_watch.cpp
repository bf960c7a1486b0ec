// SPDX-License-Identifier: Apache-2.0
#include "tests/support/machine_watch.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include <pthread.h>
#include <sched.h>

namespace tactus::test {

namespace {

constexpr std::int64_t period_ns = 1'000'000, limit_ns = 1'000'000;

std::int64_t now_ns() {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

MachineWatch::MachineWatch() : thread_([this] { watch(); }) {}

MachineWatch::~MachineWatch() {
    is_over_ = true;
    thread_.join();
}

void MachineWatch::watch() {
    sched_param highest{};
    highest.sched_priority = ::sched_get_priority_max(SCHED_FIFO);
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &highest);
    std::int64_t due = now_ns();
    while (!is_over_) {
        due += period_ns;
        const timespec time{due / 1'000'000'000, due % 1'000'000'000};
        ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
        const std::int64_t now = now_ns(), lateness = now - due;
        wakes_ += 1 + lateness / period_ns;
        worst_ns_ = std::max<std::int64_t>(worst_ns_, lateness);
        if (lateness < limit_ns) continue;
        ++late_;
        due = now;
    }
}

std::string MachineWatch::text() const {
    char text[160];
    std::snprintf(text, sizeof text, "woke a thread that does nothing late %lld times in %.1f s, at worst by %.1f ms",
                  static_cast<long long>(late_), static_cast<double>(wakes_ * period_ns) * 1e-9,
                  static_cast<double>(worst_ns_) * 1e-6);
    return text;
}

}  // namespace tactus::test
