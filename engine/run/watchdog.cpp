// SPDX-License-Identifier: Apache-2.0
#include "engine/run/watchdog.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/made_thread.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>

namespace tactus::run {

namespace {

constexpr std::int64_t look_every_ns = 1'000'000;
constexpr std::int64_t longest_wait_ns = 200'000'000;
constexpr int priority = 84;  // above every group, below the threads of the devices

}  // namespace

Watchdog::~Watchdog() {
    ending_.store(true, std::memory_order_release);
    if (thread_.joinable()) thread_.join();
}

void Watchdog::begin() {
    thread_ = made_thread("that watches over the run", [this] { run(); });
}

void Watchdog::watch(build::DeviceSlot& slot) {
    const std::size_t count = count_.load(std::memory_order_relaxed);
    if (count == watches_.size()) throw Error(fmt::format("more than {} haptic devices in one run", watches_.size()));
    watches_[count] = std::make_unique<io::DeviceWatch>(slot);
    count_.store(count + 1, std::memory_order_release);
}

void Watchdog::forget_beyond(std::size_t count) {
    if (count >= watched()) return;
    // Whoever lets go of all hands at this moment may look at these once more: their memory stays until the last moment.
    const std::size_t had = count_.exchange(count, std::memory_order_acq_rel);
    sleep_for(2 * look_every_ns);
    for (std::size_t i = count; i < had; ++i) watches_[i].reset();
}

void Watchdog::let_go() noexcept {
    for (std::size_t i = 0; i < count_.load(std::memory_order_acquire); ++i) watches_[i]->slot().guard.let_go();
}

void Watchdog::take_up() noexcept {
    for (std::size_t i = 0; i < count_.load(std::memory_order_acquire); ++i) watches_[i]->slot().guard.take_up();
}

bool Watchdog::farewell() {
    ending_.store(true, std::memory_order_release);
    if (thread_.joinable()) thread_.join();
    for (std::size_t i = 0; i < watched(); ++i) watches_[i]->end();
    const std::int64_t give_up = steady_ns() + longest_wait_ns;
    bool all = true;
    for (std::size_t i = 0; i < watched(); ++i) {
        while (!watches_[i]->is_over()) {
            if (steady_ns() > give_up && watches_[i]->forsake()) {
                all = false;
                break;
            }
            sleep_for(look_every_ns);
        }
    }
    return all;
}

void Watchdog::run() noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    while (!ending_.load(std::memory_order_acquire)) {
        look_();
        sleep_for(look_every_ns);
    }
}

}  // namespace tactus::run
