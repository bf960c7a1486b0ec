// SPDX-License-Identifier: Apache-2.0
// When forces come back by themselves after a tick was late. A late tick says nothing against the patch or the device:
// the force was cut because the machine was busy.
#pragma once

#include <array>
#include <cstddef>

namespace tactus::control {

/// Of one hand. Real-time safe.
class LateReturn {
public:
    static constexpr double quiet_s = 0.5;  ///< the hand was given no force for this long, and ...
    static constexpr double on_time_s = 1.0;  ///< ... ticks were on time for this long, before forces come back
    /// That may be left out within `on_time_s`, one or two at once: a busy machine always leaves out some, and a force
    /// that is held for 2 ms harms nobody.
    static constexpr int max_left_out = 10;
    static constexpr double ramp_s = 0.5;  ///< in which they then come in, at least
    static constexpr int max_returns = 3;  ///< in `window_s`; the next loss waits for a person
    static constexpr double window_s = 60.0;
    /// A person who lets forces come back is there for this long after they may come at the earliest.
    static constexpr double attended_s = 10.0;

    /// `period_s`: nominal, of the ticks. `at_least_s`: forces stay away for this long, at least `on_time_s`. Earlier
    /// returns still count; the waits begin anew.
    void prepare(double period_s, double at_least_s) noexcept;

    /// Each tick, whatever the state. `is_late`: the force of a tick came too late. `is_quiet`: the hand was given no force
    /// since the last tick. `elapsed_s`: since that tick, more than a period when ticks were left out.
    void tick(bool is_late, bool is_quiet, double elapsed_s) noexcept;

    /// Forces were lost to a late tick, or a tick was late while they were away.
    void lose() noexcept;
    /// Since `lose`, until `returns`: a late tick is not forgotten for another fault that passes, nor for an edit.
    bool is_lost() const noexcept { return is_lost_; }
    /// True once when forces may come back; that counts as a return.
    bool returns() noexcept;
    /// Since `returns`: forces are not back in full.
    bool comes_in() const noexcept { return comes_in_; }
    /// Each tick of that time. A return counts from when forces are on, which may be long after they may come back;
    /// `are_full`: the ramp is over.
    void come_in(bool are_on, bool are_full) noexcept;
    /// Forces come back by themselves no more: they did so `max_returns` times within `window_s` before they were lost.
    bool needs_hand() const noexcept { return needs_hand_; }
    /// A person lets forces come back: earlier returns are forgotten. If they do not come back in the time of
    /// `is_attended`, forces that needed a person before need one again.
    void forgive() noexcept;
    /// Since `forgive`, until `returns`, for at most the wait and `attended_s`.
    bool is_attended() const noexcept { return is_attended_; }

private:
    /// So many ticks were left out. True when they are too many at once, or within `on_time_s`.
    bool leaves_out_too_many(double ticks) noexcept;

    double period_s_ = 0.001, wait_s_ = on_time_s;
    double now_s_ = 0.0, on_time_ = 0.0, quiet_ = 0.0, attended_since_ = 0.0;
    std::array<double, max_returns> at_{};  // times of the last returns
    std::array<double, max_left_out> left_out_at_{};  // times of the last ticks that were left out, a ring
    std::size_t next_left_out_ = 0;
    int count_ = 0, left_out_ = 0;  // entries of the two
    bool needs_hand_ = false, is_lost_ = false, comes_in_ = false;
    bool is_attended_ = false, needed_hand_ = false;
};

}  // namespace tactus::control
