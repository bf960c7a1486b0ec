// SPDX-License-Identifier: Apache-2.0
// Decides which force a device's process gives, from the engine's commits and their age.
#pragma once

#include "devices/hosted/block.hpp"
#include "dsp/control/force_bounds.hpp"
#include "dsp/core/types.hpp"

#include <cstdint>

namespace tactus::hosted {

/// Passes forces while the engine's last commit is recent. An old force fades to zero; afterwards forces pass only
/// after some small ones, so that a returning engine does not throw the hand.
class ForceGate {
public:
    std::int64_t limit_ns = 10'000'000;  ///< age at which a commit counts as lost
    std::int64_t fade_ns = 5'000'000;  ///< duration of the fade to zero
    double small_force = 0.5, small_torque = 0.05;  ///< N, N·m
    int small_commits = 3;
    control::ForceBounds bounds;  ///< of the device
    bool is_felt = true;  ///< false: the device has no motors, and every force passes

    /// Returns the force for the device now. `number` is that of Seqlock::read. Real-time safe; does not allocate.
    Wrench give(const ForceRecord& newest, std::uint64_t number, std::int64_t now_ns) noexcept;

    /// True if forces pass.
    bool passes() const noexcept { return passes_; }
    /// True if requested forces do not pass, because the engine was lost meanwhile or began with a large force.
    bool holds() const noexcept { return !passes_ && (was_lost_ || wants_large_); }

private:
    void close(std::int64_t fade_from_ns) noexcept;

    Wrench last_;
    std::int64_t fade_from_ns_ = INT64_MIN / 2;
    std::uint64_t number_ = 0;
    int small_ = 0;
    bool passes_ = false, was_lost_ = false, wants_large_ = false;
};

/// True if the stamp is neither older than `limit_ns` nor in the future, as a corrupt stamp may be.
constexpr bool is_young(std::int64_t stamp_ns, std::int64_t now_ns, std::int64_t limit_ns) noexcept {
    constexpr std::int64_t clocks_differ_ns = 1'000'000;
    return stamp_ns > 0 && stamp_ns <= now_ns + clocks_differ_ns && stamp_ns >= now_ns - limit_ns;
}

}  // namespace tactus::hosted
