// SPDX-License-Identifier: Apache-2.0
// The watchdog of one device: its own thread, with a priority above every group, that checks the device once a
// millisecond. A driver that blocks this thread delays nothing else. While the kernel throttles all real-time threads,
// a thread of normal priority takes over.
#pragma once

#include "engine/io/device_slot.hpp"
#include "engine/io/driver_gate.hpp"

#include <atomic>
#include <cstdint>
#include <thread>

namespace tactus::run {

/// All functions: control thread.
class DeviceWatch {
public:
    /// Throws std::system_error when the system refuses the thread.
    explicit DeviceWatch(io::DeviceSlot& slot);
    /// Joins the thread, unless it was abandoned.
    ~DeviceWatch();
    DeviceWatch(const DeviceWatch&) = delete;
    DeviceWatch& operator=(const DeviceWatch&) = delete;

    io::DeviceSlot& slot() const { return slot_; }
    /// Ends the thread as soon as the retired device is without force, at the latest after 0.1 s; with `at_once`
    /// immediately.
    void end(bool at_once = false) noexcept;
    bool is_over() const noexcept { return is_over_.load(std::memory_order_acquire); }
    /// Abandons the thread if it is in the driver. Then neither this object nor the device may be destroyed.
    bool forsake();
    /// For another thread, without real-time priority: checks the device if its own thread has not done so for 3 ms.
    /// Returns false if the caller was abandoned in the driver; it must not access anything any more.
    bool stand_in() noexcept;

private:
    void run() noexcept;
    /// One check, by one of the two threads at a time. Returns false as `stand_in` does.
    bool look(std::int64_t now_ns) noexcept;

    io::DeviceSlot& slot_;
    io::DriverGate driver_;
    enum Ending : int { no, soon, now };
    std::atomic<int> ending_{no};
    std::atomic<bool> is_looking_{false};
    std::atomic<std::int64_t> looked_ns_{0};
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

}  // namespace tactus::run
