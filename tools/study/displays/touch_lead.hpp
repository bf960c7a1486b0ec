// SPDX-License-Identifier: Apache-2.0
// Which place is to be touched next, and what becomes of each touch. Whoever reads the device waits, or does not.
#pragma once

#include "dsp/display/rig_touches.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tactus::study {

/// One touch as it was read.
struct Touched {
    Vec3 tip{0.0}, tracked{0.0};  ///< means over the touch, m, each in its own frame
    double moved = 0.0;           ///< m, the farthest from the mean
    std::size_t samples = 0, tracked_samples = 0;  ///< what the means are of
};
inline constexpr double touch_lasts = 0.2;  ///< s that a touch is read

/// The touch that was read as those places of the tip, and of what tracks it.
Touched touch_of(std::span<const Vec3> tips, std::span<const Vec3> tracked);

/// Fills the readings of steps one by one. A touch that moved is asked for again, one of fewer than ten samples, one whose
/// place was not tracked where it has to be, and one that `check`, called after the last of a part, throws as BadTouch.
class TouchLead {
public:
    using Check = std::function<void(std::span<const display::RigTouch> done)>;

    /// `has_tracker`: workspace touches get their place from what was tracked. Throws Error without steps.
    TouchLead(std::vector<display::RigTouch> steps, bool has_tracker, Check check);

    bool is_done() const { return due_ == steps_.size(); }
    /// The step that is due, from 0.
    std::size_t due() const { return due_; }
    const std::vector<display::RigTouch>& steps() const { return steps_; }
    /// Takes the touch of the step that is due. Returns why one has to be made again, this or one before; empty: none.
    /// Throws Error for a place that does not come out right the third time, and what `check` throws else.
    std::string take(const Touched& touched);

private:
    /// Its place comes from the tracker.
    bool is_tracked(const display::RigTouch& step) const {
        return has_tracker_ && step.of == display::RigTouch::Of::workspace;
    }
    /// What is wrong with a touch of the step that is due, whatever the others are; empty: nothing.
    std::string fault_of(const Touched& touched) const;
    /// The touches so far complete a part: a device, the mirror, or one screen.
    bool is_part_done() const;

    std::vector<display::RigTouch> steps_;
    std::vector<int> tries_;
    std::size_t due_ = 0, reached_ = 0;  // touches before `reached_` are filled
    bool has_tracker_;
    Check check_;
};

}  // namespace tactus::study
