// SPDX-License-Identifier: Apache-2.0
// What keeps the hands of a live run safe beside the ticks: a thread for each device, and one that acts at once when the
// run is to pause or to end. Neither waits for a disk, for a group or for another device. When real-time threads use a core
// for 950 ms of a second, the kernel stops all of them until the next second; a twin of normal priority acts meanwhile.
#pragma once

#include "engine/io/device_watch.hpp"

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
    /// `look` is called about once a millisecond by a thread above every group, or by its twin, never by both at once.
    explicit Watchdog(std::function<void()> look) : look_(std::move(look)) {}
    /// After `farewell`, or when no thread was ever left behind.
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Begins to look. Throws std::system_error when the system refuses the thread.
    void begin();
    /// Looks after a device, too, from now on. Throws Error when there are too many, std::system_error when the system
    /// refuses the thread.
    void watch(build::DeviceSlot& slot);
    /// The devices watched last go before they were ever used, until `count` are left.
    void forget_beyond(std::size_t count);
    std::size_t watched() const { return count_.load(std::memory_order_relaxed); }

    /// Forces on all hands fade at once and stay away, or may come again. Any thread; wait-free.
    void let_go() noexcept;
    void take_up() noexcept;

    /// Waits until every device, all of which are retired, is without force. A driver that blocks is left behind after a
    /// fifth of a second: false then.
    bool farewell();

private:
    void run() noexcept;
    void run_twin() noexcept;
    void look_once() noexcept;

    std::function<void()> look_;
    std::array<std::unique_ptr<io::DeviceWatch>, 32> watches_;
    std::atomic<std::size_t> count_{0};
    std::atomic<bool> ending_{false};
    std::atomic<bool> is_looking_{false};
    std::atomic<std::int64_t> looked_ns_{0};
    std::atomic<std::int64_t> twin_passes_{0};  ///< odd: the twin is looking after devices
    std::atomic<bool> is_twin_over_{false};
    std::thread thread_, twin_;
};

}  // namespace tactus::run
