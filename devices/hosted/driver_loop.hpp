// SPDX-License-Identifier: Apache-2.0
// The thread that owns the driver: it opens it, sends forces, publishes samples and closes it. All calls of the driver
// are made here, because some vendors' handles belong to a thread.
#pragma once

#include "devices/hosted/block.hpp"
#include "devices/hosted/force_gate.hpp"
#include "devices/hosted/message.hpp"
#include "graph/node/device.hpp"

#include <atomic>
#include <cstdint>
#include <memory>

namespace tactus::hosted {

class DriverLoop {
public:
    DriverLoop(Block& block, int socket) : block_(block), socket_(socket) {}

    /// Runs from opening to closing the device. Returns when `end` was called or the device cannot be opened.
    void run() noexcept;

    // Any thread.
    void end() noexcept { must_end_.store(true, std::memory_order_release); }
    bool is_over() const noexcept { return is_over_.load(std::memory_order_acquire); }
    bool has_failed() const noexcept { return has_failed_.load(std::memory_order_acquire); }
    /// steady_ns of the last commit received from the engine; 0: none yet.
    std::int64_t heard_ns() const noexcept { return heard_ns_.load(std::memory_order_relaxed); }

private:
    void open();
    void fail(const Error& error) noexcept;
    void serve();
    void prepare(const Words& said);
    void round() noexcept;
    void tell_pull() noexcept;
    void give_drive(std::int64_t now_ns) noexcept;
    void fade() noexcept;

    Block& block_;
    const int socket_;
    std::unique_ptr<HapticDevice> device_;
    std::shared_ptr<const haptic::PullLink> pull_;  // null: the driver pulls no hand
    std::uint64_t pull_number_ = 0;
    int fingers_ = 0;
    ForceGate gate_;
    ForceRecord force_;
    DriveRecord drive_;
    std::uint64_t force_number_ = 0, drive_number_ = 0;
    Wrench given_;
    std::int64_t round_ns_ = 1'000'000, last_ns_ = 0, held_ns_ = 0;
    bool is_prepared_ = false, moves_ = false;
    std::atomic<bool> must_end_{false}, is_over_{false}, has_failed_{false};
    std::atomic<std::int64_t> heard_ns_{0};
};

}  // namespace tactus::hosted
