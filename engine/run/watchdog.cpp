// SPDX-License-Identifier: Apache-2.0
#include "engine/run/watchdog.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/made_thread.hpp"
#include "engine/run/priority_watch.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>

namespace tactus::run {

namespace {

constexpr std::int64_t look_every_ns = 1'000'000;
constexpr std::int64_t twin_acts_after_ns = 3'000'000;
constexpr std::int64_t longest_wait_ns = 200'000'000;
constexpr int priority = 84;  // above every group, below the threads of the devices

}  // namespace

Watchdog::~Watchdog() {
    ending_.store(true, std::memory_order_release);
    if (thread_.joinable()) thread_.join();
    if (twin_.joinable()) twin_.join();
}

void Watchdog::begin() {
    thread_ = made_thread("that watches over the run", [this] { run(); });
    twin_ = made_thread("that watches over the run without real-time priority", [this] { run_twin(); });
}

void Watchdog::watch(io::DeviceSlot& slot) {
    const std::size_t count = count_.load(std::memory_order_relaxed);
    if (count == watches_.size()) throw Error(fmt::format("more than {} haptic devices in one run", watches_.size()));
    watches_[count] = std::make_unique<DeviceWatch>(slot);
    count_.store(count + 1, std::memory_order_release);
}

void Watchdog::forget_beyond(std::size_t count) {
    if (count >= watched()) return;
    // A thread that is releasing all forces may still read these slots, so their memory is kept until it has passed.
    const std::size_t had = count_.exchange(count, std::memory_order_acq_rel);
    const std::int64_t passes = twin_passes_.load(std::memory_order_acquire);
    sleep_for(2 * look_every_ns);
    while (passes % 2 != 0 && twin_passes_.load(std::memory_order_acquire) == passes) sleep_for(look_every_ns);
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
    // A driver may have blocked the twin, too.
    if (!twin_.joinable()) return all;
    const std::int64_t until = steady_ns() + longest_wait_ns;
    while (!is_twin_over_ && steady_ns() < until) sleep_for(look_every_ns);
    if (!is_twin_over_) {
        twin_.detach();
        return false;
    }
    twin_.join();
    return all;
}

void Watchdog::look_once() noexcept {
    if (is_looking_.exchange(true, std::memory_order_acquire)) return;
    look_();
    looked_ns_.store(steady_ns(), std::memory_order_relaxed);
    is_looking_.store(false, std::memory_order_release);
}

void Watchdog::run() noexcept {
    set_priority(pthread_self(), priority);
    while (!ending_.load(std::memory_order_acquire)) {
        look_once();
        sleep_for(look_every_ns);
    }
}

void Watchdog::run_twin() noexcept {
    while (!ending_.load(std::memory_order_acquire)) {
        if (steady_ns() - looked_ns_.load(std::memory_order_relaxed) > twin_acts_after_ns) look_once();
        twin_passes_.fetch_add(1, std::memory_order_acq_rel);
        for (std::size_t i = 0; i < count_.load(std::memory_order_acquire); ++i)
            if (!watches_[i]->stand_in()) return;
        twin_passes_.fetch_add(1, std::memory_order_acq_rel);
        sleep_for(look_every_ns);
    }
    is_twin_over_ = true;
}

}  // namespace tactus::run
