// SPDX-License-Identifier: Apache-2.0
#include "engine/io/device_watch.hpp"

#include "dsp/core/clock.hpp"
#include "engine/run/made_thread.hpp"

#include <pthread.h>

#include <algorithm>

namespace tactus::io {

namespace {

constexpr std::int64_t poll_every_ns = 1'000'000;
constexpr std::int64_t longest_farewell_ns = 100'000'000;
constexpr int priority = 85;  // above every group

}  // namespace

DeviceWatch::DeviceWatch(build::DeviceSlot& slot)
    : slot_(slot), thread_(run::made_thread("that guards the device " + slot.name, [this] { run(); })) {}

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

void DeviceWatch::run() noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    // Refused for the groups as well then, which is told once.
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    std::int64_t next = steady_ns(), give_up = 0;
    for (;;) {
        const std::int64_t time = steady_ns();
        const int ending = ending_.load(std::memory_order_acquire);
        if (ending == now) break;
        driver_.enter();
        slot_.guard.poll(*slot_.device, time);
        if (!driver_.leave()) return;
        if (ending == soon && give_up == 0) give_up = time + longest_farewell_ns;
        if (ending == soon && (slot_.guard.is_at_rest() || time > give_up)) break;
        next = std::max(next + poll_every_ns, time);
        sleep_until(next);
    }
    is_over_.store(true, std::memory_order_release);
}

}  // namespace tactus::io
