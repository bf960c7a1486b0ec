// SPDX-License-Identifier: Apache-2.0
#include "engine/run/device_watch.hpp"

#include "dsp/core/clock.hpp"
#include "engine/run/made_thread.hpp"

#include <pthread.h>

#include <algorithm>

namespace tactus::run {

namespace {

constexpr std::int64_t poll_every_ns = 1'000'000;
constexpr std::int64_t stands_in_after_ns = 3'000'000;
constexpr std::int64_t longest_farewell_ns = 100'000'000;
constexpr int priority = 85;  // above every group

}  // namespace

DeviceWatch::DeviceWatch(io::DeviceSlot& slot)
    : slot_(slot), thread_(made_thread("that guards the device " + slot.name, [this] { run(); })) {}

DeviceWatch::~DeviceWatch() {
    end(true);
    if (thread_.joinable()) thread_.join();
}

void DeviceWatch::end(bool at_once) noexcept {
    ending_.store(std::max<int>(ending_.load(), at_once ? now : soon), std::memory_order_release);
}

bool DeviceWatch::forsake() {
    if (!driver_.forsake()) return false;
    thread_.detach();
    return true;
}

bool DeviceWatch::look(std::int64_t now_ns) noexcept {
    if (is_looking_.exchange(true, std::memory_order_acquire)) return true;
    if (!driver_.enter()) return false;
    slot_.guard.poll(*slot_.device, now_ns);
    if (!driver_.leave()) return false;
    looked_ns_.store(now_ns, std::memory_order_relaxed);
    is_looking_.store(false, std::memory_order_release);
    return true;
}

bool DeviceWatch::stand_in() noexcept {
    const std::int64_t now_ns = steady_ns(), looked_ns = looked_ns_.load(std::memory_order_relaxed);
    if (looked_ns == 0 || now_ns - looked_ns < stands_in_after_ns || is_over()) return true;
    return look(now_ns);
}

void DeviceWatch::run() noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    // If this fails, it fails for the groups too, and they report it.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    std::int64_t next = steady_ns(), give_up = 0;
    for (;;) {
        const std::int64_t time = steady_ns();
        const int ending = ending_.load(std::memory_order_acquire);
        if (ending == now) break;
        if (!look(time) || driver_.is_forsaken()) return;
        if (ending == soon && give_up == 0) give_up = time + longest_farewell_ns;
        if (ending == soon && (slot_.guard.is_at_rest() || time > give_up)) break;
        next = std::max(next + poll_every_ns, time);
        sleep_until(next);
    }
    is_over_.store(true, std::memory_order_release);
}

}  // namespace tactus::run
