// SPDX-License-Identifier: Apache-2.0
// Keeps the hands of a live run safe independently of the ticks: one thread for each device, and one that immediately
// pauses or ends the run on request. None of them waits for a disk, a group or another device. When real-time threads
// use a core for 950 ms of a second, the kernel stops all of them until the next second; meanwhile a twin thread of
// normal priority takes over.
#pragma once

#include "engine/run/device_watch.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

namespace tactus::run {

/// Control thread.
class Watchdog {
public:
    /// `look` is called about once a millisecond by a thread with a priority above every group, or by its twin, but
    /// never by both at the same time.
    explicit Watchdog(std::function<void()> look) : look_(std::move(look)) {}
    /// Call after `farewell`, or if no thread was ever abandoned.
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Starts the thread. Throws std::system_error when the system refuses it.
    void begin();
    /// Adds a device. Throws Error if there are too many, std::system_error when the system refuses the thread.
    void watch(io::DeviceSlot& slot);
    /// Removes the devices added last, which were never used, until `count` are left.
    void forget_beyond(std::size_t count);
    std::size_t watched() const { return count_.load(std::memory_order_relaxed); }

    /// Fades forces on all hands immediately and keeps them at zero, or allows them again. Any thread; wait-free.
    void let_go() noexcept;
    void take_up() noexcept;

    /// Waits until every device is without force; all must be retired. Returns false if a driver blocks: its thread is
    /// abandoned after a fifth of a second.
    bool farewell();

private:
    void run() noexcept;
    void run_twin() noexcept;
    void look_once() noexcept;

    std::function<void()> look_;
    std::array<std::unique_ptr<DeviceWatch>, 32> watches_;
    std::atomic<std::size_t> count_{0};
    std::atomic<bool> ending_{false};
    std::atomic<bool> is_looking_{false};
    std::atomic<std::int64_t> looked_ns_{0};
    std::atomic<std::int64_t> twin_passes_{0};  ///< odd: the twin is checking devices
    std::atomic<bool> is_twin_over_{false};
    std::thread thread_, twin_;
};

}  // namespace tactus::run
