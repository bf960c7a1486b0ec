// SPDX-License-Identifier: Apache-2.0
// Which force a device's process gives, from what the engine committed and when.
#pragma once

#include "devices/hosted/block.hpp"
#include "dsp/control/force_bounds.hpp"
#include "dsp/core/types.hpp"

#include <cstdint>

namespace tactus::hosted {

/// Forces pass while the engine's last commit is young. An old one fades to zero; then forces pass only after some small
/// ones, so that a hand is not thrown out by an engine that comes back.
class ForceGate {
public:
    std::int64_t limit_ns = 10'000'000;  ///< age of a commit at which the engine counts as lost
    std::int64_t fade_ns = 5'000'000;  ///< from there to zero
    double small_force = 0.5, small_torque = 0.05;  ///< N, N·m
    int small_commits = 3;
    control::ForceBounds bounds;  ///< of the device
    bool is_felt = true;  ///< false: the device has no motors, and every force passes

    /// The force for the device now. `number` is that of Seqlock::read. Real-time; allocates nothing.
    Wrench give(const ForceRecord& newest, std::uint64_t number, std::int64_t now_ns) noexcept;

    /// Forces pass.
    bool passes() const noexcept { return passes_; }
    /// Forces that the engine wants do not pass: it was lost meanwhile, or it began with a large one.
    bool holds() const noexcept { return !passes_ && (was_lost_ || wants_large_); }

private:
    void close(std::int64_t fade_from_ns) noexcept;

    Wrench last_;
    std::int64_t fade_from_ns_ = INT64_MIN / 2;
    std::uint64_t number_ = 0;
    int small_ = 0;
    bool passes_ = false, was_lost_ = false, wants_large_ = false;
};

/// Neither older than `limit_ns` nor from the future, as a broken stamp may be.
constexpr bool is_young(std::int64_t stamp_ns, std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    constexpr std::int64_t clocks_differ_ns = 1'000'000;
    return stamp_ns > 0 && stamp_ns <= now_ns + clocks_differ_ns && stamp_ns >= now_ns - limit_ns;
}

}  // namespace tactus::hosted
