// SPDX-License-Identifier: Apache-2.0
// Keeps the ring between an engine and a sound card at its level for ever, by trimming the engine's clock.
#pragma once

#include "dsp/control/delay_locked_loop.hpp"
#include "dsp/control/trimmed_clock.hpp"
#include "dsp/core/time.hpp"

#include <cstdint>

namespace tactus::control {

/// What a card had done when it last asked for sound.
struct CardView {
    std::int64_t asked = 0;      ///< frames asked for since it was opened
    std::int64_t next = 0;       ///< index of the frame, as the engine counts them, that it will take next
    std::int64_t steady_ns = 0;  ///< when
    std::int64_t largest = 0;    ///< most frames that it asked for at once
};

/// The engine is to make frame `next + target()` at the smoothed time at which the card asks: then the ring holds the
/// target after each callback, however the clocks differ. Small errors bend the clock; when the card or the engine stood
/// still for so long that more than the margin has gathered on top, frames are left out instead.
class CardFollower {
public:
    /// `rate` of the card, Hz; `margin_s` of sound that waits in the ring for late threads.
    void prepare(double rate, double margin_s) noexcept;

    /// Call some ten times per second or more. `reached` is the logical time that the engine has come to. Returns how
    /// many frames the card should leave out; the caller counts them into `next` from then on.
    std::int64_t follow(const CardView& card, Flicks reached, TrimmedClock& clock) noexcept;

    /// Frames that shall wait in the ring after a callback.
    std::int64_t target() const noexcept { return margin_ + largest_; }
    /// How much more than the target waits, by the two clocks, s.
    double excess_s() const noexcept { return excess_ns_ * 1e-9; }
    const DelayLockedLoop& loop() const noexcept { return loop_; }

private:
    static constexpr std::int64_t patience = 10;  // looks in a row that find too much

    DelayLockedLoop loop_;
    Flicks frame_ = flicks_per_second / 48000;
    double rate_ = 48000.0, excess_ns_ = 0.0;
    std::int64_t margin_ = 0, largest_ = 0, too_much_ = 0, asked_ = -1;
};

}  // namespace tactus::control
