// SPDX-License-Identifier: Apache-2.0
// The second watchdog of one device: a thread of its own, above every group, that looks after it once a millisecond. A
// driver that blocks it holds up nobody else. While the kernel stops all threads of real-time priority, another thread
// stands in for it.
#pragma once

#include "engine/build/group_program.hpp"
#include "engine/io/driver_gate.hpp"

#include <atomic>
#include <cstdint>
#include <thread>

namespace tactus::io {

/// All functions: control thread.
class DeviceWatch {
public:
    /// Throws std::system_error when the system refuses the thread.
    explicit DeviceWatch(build::DeviceSlot& slot);
    /// Joins, unless the thread was left behind.
    ~DeviceWatch();
    DeviceWatch(const DeviceWatch&) = delete;
    DeviceWatch& operator=(const DeviceWatch&) = delete;

    build::DeviceSlot& slot() const { return slot_; }
    /// The thread ends as soon as the device, which is retired, is without force, at the latest after 0.1 s; `at_once`:
    /// whatever there is.
    void end(bool at_once = false) noexcept;
    bool is_over() const noexcept { return is_over_.load(std::memory_order_acquire); }
    /// Leaves the thread behind if it is in the driver. This must not be destroyed then, nor the device.
    bool forsake();
    /// Another thread, without real-time priority: looks after the device if its own thread has not done so for 3 ms. False
    /// when the caller was left behind in the driver; it must touch nothing any more.
    bool stand_in() noexcept;

private:
    void run() noexcept;
    /// One look, by one of the two threads at a time. False as for `stand_in`.
    bool look(std::int64_t now_ns) noexcept;

    build::DeviceSlot& slot_;
    DriverGate driver_;
    enum Ending : int { no, soon, now };
    std::atomic<int> ending_{no};
    std::atomic<bool> is_looking_{false};
    std::atomic<std::int64_t> looked_ns_{0};
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

}  // namespace tactus::io
