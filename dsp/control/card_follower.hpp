// SPDX-License-Identifier: Apache-2.0
// Keeps the fill level of the ring between engine and sound card by trimming the engine's clock.
#pragma once

#include "dsp/control/delay_locked_loop.hpp"
#include "dsp/control/trimmed_clock.hpp"
#include "dsp/core/time.hpp"

#include <cstdint>

namespace tactus::control {

/// State of a card at its last request for sound.
struct CardView {
    std::int64_t asked = 0;  ///< frames requested since it was opened
    std::int64_t next = 0;  ///< index of the frame that it will take next, in the engine's count
    std::int64_t steady_ns = 0;  ///< time of the request
    std::int64_t largest = 0;  ///< most frames in one request
};

/// The engine should compute frame `next + target()` at the smoothed time of the card's requests: then the ring holds
/// the target after each callback, however the clocks differ. Small errors change the clock's rate; after a stall of
/// card or engine that leaves more than the margin above the target, frames are skipped instead.
class CardFollower {
public:
    /// `rate` of the card, Hz; `margin_s` of sound that stays in the ring for late threads.
    void prepare(double rate, double margin_s) noexcept;

    /// Call at least ten times per second. `now_ns` is the steady time. Returns the number of frames that the card should
    /// skip; the caller adds them to `next` from then on.
    std::int64_t follow(const CardView& card, std::int64_t now_ns, TrimmedClock& clock) noexcept;

    /// Frames that should remain in the ring after a callback.
    std::int64_t target() const noexcept { return margin_ + largest_; }
    /// Sound above the target, by the two clocks, s.
    double excess_s() const noexcept { return excess_ns_ * 1e-9; }
    const DelayLockedLoop& loop() const noexcept { return loop_; }

private:
    static constexpr std::int64_t patience = 10;  // consecutive calls with too much before frames are skipped

    DelayLockedLoop loop_;
    Flicks frame_ = flicks_per_second / 48000;
    double rate_ = 48000.0, excess_ns_ = 0.0;
    std::int64_t margin_ = 0, largest_ = 0, too_much_ = 0, asked_ = -1;
};

}  // namespace tactus::control
