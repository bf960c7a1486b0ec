// SPDX-License-Identifier: Apache-2.0
// Synchronises a thread that calls a driver with the thread that ends the run: a thread that does not return from a
// driver is abandoned, and accesses nothing if it returns later.
#pragma once

#include <atomic>

namespace tactus::io {

class DriverGate {
    enum Place : int { outside, inside, forsaken };
    static_assert(std::atomic<int>::is_always_lock_free);

public:
    // Thread that calls the driver; wait-free.
    /// Returns false if the run has ended for this thread.
    bool enter() noexcept { return move(outside, inside); }
    /// Returns false if the run has ended for this thread; it must not access anything any more.
    bool leave() noexcept { return move(inside, outside); }

    /// Any thread: abandons the other thread if it is inside the driver.
    bool forsake() noexcept { return move(inside, forsaken); }
    /// Any thread.
    bool is_forsaken() const noexcept { return place_.load(std::memory_order_acquire) == forsaken; }

private:
    bool move(int from, int to) noexcept { return place_.compare_exchange_strong(from, to, std::memory_order_acq_rel); }

    std::atomic<int> place_{outside};
};

}  // namespace tactus::io
