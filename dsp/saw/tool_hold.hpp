// SPDX-License-Identifier: Apache-2.0
// When a tool begins to feel bone, and when it stops.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus::saw {

enum class HoldState : std::uint8_t {
    waiting,  ///< the tool lies in bone that it has not cut: no force until all of it is free
    engaged,  ///< bone holds it
    releasing,  ///< the force fades
};

/// Bone that a tool has not cut holds it, however hard the hand pushes: no lag and no force releases it. It is released
/// on request, after a jump, and after 2 s in which the hand was outside of the bone while the tool was stuck: its force
/// was saturated, as behind a thin wall, or held the hand back, as under a bar. The force then fades over 100 ms, and the
/// tool engages anew where all of it is free.
class ToolHold {
public:
    static constexpr double fade_time = 0.1, patience = 2.0;  // s

    HoldState state() const noexcept { return state_; }

    /// Part of its lag that a point keeps in this tick of a release: 1 to 0 over `fade_time`, whatever the rate.
    double kept() const noexcept { return kept_; }

    /// One tick of `dt` s. `asked`: the tool is to be released. `stuck`: its force does not grow any more, or draws it on into
    /// the bone. `is_free()`: no part of the tool, where the hand is, lies in bone; it is evaluated when it matters.
    template <class IsFree>
    void tick(double dt, bool asked, bool stuck, IsFree&& is_free) noexcept {
        if (state_ == HoldState::engaged) {
            stuck_ = stuck && is_free() ? stuck_ + dt : 0.0;
            if (asked || stuck_ >= patience) {
                state_ = HoldState::releasing;
                left_ = fade_time;
            }
        }
        if (state_ == HoldState::releasing) {
            const double after = left_ - dt;
            kept_ = after > 1e-9 ? after / left_ : 0.0;
            left_ = after;
            // The last tick of the fade has no force; the tool may engage in the next.
            if (kept_ == 0.0) {
                state_ = HoldState::waiting;
                stuck_ = 0.0;
            }
        } else if (state_ == HoldState::waiting && !asked && is_free()) {
            state_ = HoldState::engaged;
        }
    }

    /// No bone holds the tool any more, without a fade.
    void drop() noexcept { *this = {}; }

private:
    HoldState state_ = HoldState::waiting;
    double stuck_ = 0.0, left_ = 0.0, kept_ = 1.0;  // s, s, share
};

}  // namespace tactus::saw
