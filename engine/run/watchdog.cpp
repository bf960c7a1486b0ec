// SPDX-License-Identifier: Apache-2.0
#include "engine/run/watchdog.hpp"

#include "engine/run/clock.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>

namespace tactus::run {

namespace {

constexpr std::int64_t poll_every_ns = 1'000'000;
constexpr std::int64_t longest_farewell_ns = 100'000'000;
constexpr int priority = 85;  // above every group

}  // namespace

Watchdog::Watchdog() : thread_([this] { run(); }) {}

Watchdog::~Watchdog() { ending_.store(true, std::memory_order_release); }

void Watchdog::watch(build::DeviceSlot& slot) {
    const std::size_t count = count_.load(std::memory_order_relaxed);
    if (count == slots_.size()) throw Error(fmt::format("more than {} haptic devices in one run", slots_.size()));
    slots_[count] = &slot;
    count_.store(count + 1, std::memory_order_release);
}

void Watchdog::run() noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    // Refused for the groups as well then, which is told once.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    std::int64_t next = steady_ns(), give_up = 0;
    for (;;) {
        const std::int64_t now = steady_ns();
        const bool ending = ending_.load(std::memory_order_acquire);
        bool at_rest = true;
        for (std::size_t i = 0; i < count_.load(std::memory_order_acquire); ++i) {
            slots_[i]->guard.poll(*slots_[i]->device, now);
            at_rest = at_rest && slots_[i]->guard.is_at_rest();
        }
        if (ending && give_up == 0) give_up = now + longest_farewell_ns;
        if (ending && (at_rest || now > give_up)) return;
        next = std::max(next + poll_every_ns, now);
        sleep_until(next);
    }
}

}  // namespace tactus::run
