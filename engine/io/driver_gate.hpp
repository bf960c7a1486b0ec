// SPDX-License-Identifier: Apache-2.0
// Between a thread that calls a driver and the one that ends the run: a thread that does not come back from a driver is
// left behind, and touches nothing when it comes back after all.
#pragma once

#include <atomic>

namespace tactus::io {

class DriverGate {
    enum Place : int { outside, inside, forsaken };
    static_assert(std::atomic<int>::is_always_lock_free);

public:
    // Thread that calls the driver; wait-free.
    /// False: the run is over for this thread.
    bool enter() noexcept { return move(outside, inside); }
    /// False: the run is over for this thread; it must touch nothing any more.
    bool leave() noexcept { return move(inside, outside); }

    /// Any thread: if the other one is inside, it is left behind.
    bool forsake() noexcept { return move(inside, forsaken); }
    /// Any thread.
    bool is_forsaken() const noexcept { return place_.load(std::memory_order_acquire) == forsaken; }

private:
    bool move(int from, int to) noexcept { return place_.compare_exchange_strong(from, to, std::memory_order_acq_rel); }

    std::atomic<int> place_{outside};
};

}  // namespace tactus::io
