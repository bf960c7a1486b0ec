// SPDX-License-Identifier: Apache-2.0
// The sequence of touches of a calibration, with the acceptance test of each. Independent of the way in which the
// device is read.
#pragma once

#include "dsp/display/display_fit.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// The readings of one touch.
struct Touched {
    Vec3 tip{0.0}, tracked{0.0};  ///< means over the touch, m, each in the frame of its device
    double moved = 0.0;           ///< m, largest distance from the mean
    std::size_t samples = 0, tracked_samples = 0;  ///< number of samples in the means
};
inline constexpr double touch_lasts = 0.2;  ///< duration of a touch, s

/// Combines positions of the tip, and of the tracked marker, into one touch.
Touched touch_of(std::span<const Vec3> tips, std::span<const Vec3> tracked);

/// Fills the readings of the steps one by one. Requests a touch again if the tip moved, when it has fewer than ten
/// samples, when the required tracked position is missing, or when `check` throws BadTouch for it; `check` is called
/// after each complete part.
class TouchLead {
public:
    using Check = std::function<void(std::span<const display::Touch> done)>;

    /// `has_tracker`: workspace touches use the tracked position. Throws Error without steps.
    TouchLead(std::vector<display::Touch> steps, bool has_tracker, Check check);

    bool is_done() const { return due_ == steps_.size(); }
    /// Index of the current step.
    std::size_t due() const { return due_; }
    const std::vector<display::Touch>& steps() const { return steps_; }
    /// Adds the touch of the current step. Returns the reason why this or an earlier touch must be repeated; empty:
    /// accepted. Throws Error if a touch fails for the third time, and rethrows other errors of `check`.
    std::string take(const Touched& touched);

private:
    /// True if the position comes from the tracker.
    bool is_tracked(const display::Touch& step) const {
        return has_tracker_ && step.of == display::Touch::Of::workspace;
    }
    /// Returns the reason why a touch of the current step is invalid by itself; empty: valid.
    std::string fault_of(const Touched& touched) const;
    /// True if the touches so far complete a part: the device, the mirror, or a screen.
    bool is_part_done() const;

    std::vector<display::Touch> steps_;
    std::vector<int> tries_;
    std::size_t due_ = 0, reached_ = 0;  // touches before `reached_` are filled
    bool has_tracker_;
    Check check_;
};

}  // namespace tactus::analysis
