// SPDX-License-Identifier: Apache-2.0
// The clock of a live run: all threads read it, one trims it.
#pragma once

#include "dsp/control/trimmed_clock.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::run {

/// Time from setting the clock to the first activation.
constexpr std::int64_t start_delay_ns = 20'000'000;

class RunClock {
    static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<double>::is_always_lock_free);

public:
    /// One thread only; wait-free.
    void set(const control::TrimmedClock& clock) noexcept {
        const std::uint64_t version = version_.load(std::memory_order_relaxed);
        version_.store(version + 1, std::memory_order_relaxed);
        logical_.store(clock.logical, std::memory_order_release);
        steady_ns_.store(clock.steady_ns, std::memory_order_release);
        slope_.store(clock.slope, std::memory_order_release);
        version_.store(version + 2, std::memory_order_release);
    }

    /// Any thread. A reader that collides with the writer uses its previous line, which differs by microseconds.
    /// Wait-free.
    control::TrimmedClock get(control::TrimmedClock last) const noexcept {
        try_get(last);
        return last;
    }

    /// Any thread. Returns false and leaves `line` unchanged if no line is available: none was set yet, or one is being
    /// written. Wait-free.
    bool try_get(control::TrimmedClock& line) const noexcept {
        const std::uint64_t version = version_.load(std::memory_order_acquire);
        const control::TrimmedClock now{logical_.load(std::memory_order_acquire),
                                        steady_ns_.load(std::memory_order_acquire),
                                        slope_.load(std::memory_order_acquire)};
        if (version == 0 || version % 2 == 1 || version_.load(std::memory_order_relaxed) != version) return false;
        line = now;
        return true;
    }

private:
    std::atomic<std::uint64_t> version_{0};
    std::atomic<Flicks> logical_{0};
    std::atomic<std::int64_t> steady_ns_{0};
    std::atomic<double> slope_{1.0};
};

}  // namespace tactus::run
