// SPDX-License-Identifier: Apache-2.0
// The second watchdog: a thread of its own that looks after every device of a live run once a millisecond.
#pragma once

#include "engine/build/group_program.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <thread>

namespace tactus::run {

class Watchdog {
public:
    Watchdog();
    /// Waits until every device that was retired is without force, at most 0.1 s.
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// From now on. One thread only; the slot must outlive the watchdog. At most 32.
    void watch(build::DeviceSlot& slot);
    std::size_t watched() const { return count_.load(std::memory_order_relaxed); }

private:
    void run() noexcept;

    std::array<build::DeviceSlot*, 32> slots_{};
    std::atomic<std::size_t> count_{0};
    std::atomic<bool> ending_{false};
    std::jthread thread_;
};

}  // namespace tactus::run
