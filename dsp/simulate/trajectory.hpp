// SPDX-License-Identifier: Apache-2.0
// Plays a recorded 6-DOF path at any rate: splines within segments, minimum-jerk moves across gaps.
#pragma once

#include "dsp/simulate/hand.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::simulate {

/// One recorded sample: s, device frame.
struct TrajectorySample {
    double time = 0.0;
    Pose pose;
};

/// Limits of the motion that is added to a recording.
struct TrajectoryRules {
    double max_gap_s = 0.05;  ///< longer pauses between samples are gaps, which the spline does not bridge
    double max_speed = 0.1;           ///< m/s while easing from the end of one segment to the start of the next
    double max_angular_speed = 1.5;   ///< rad/s while easing
};

/// A state on the path.
struct TrajectoryState {
    Intention intention;
    bool gap = false;  ///< holding or easing: not recorded
    bool done = false;  ///< past the end; the last pose holds
};

/// Natural cubic splines (C²) through each segment, in position and in the four numbers of the quaternion, normalised
/// after interpolation: at the spacing of a recording the deviation from the great arc is of third order. In a gap the
/// last pose is held, then a minimum-jerk motion leads to the start of the next segment. When the gap is too short for
/// the speed limits, the rest is delayed.
class TrajectoryPlayer {
public:
    TrajectoryPlayer() = default;

    /// `samples` have strictly increasing times; `breaks` are indices of samples that start a segment for any
    /// spacing. Time 0 is the first sample. Allocates. Throws Error when there is no sample.
    TrajectoryPlayer(std::span<const TrajectorySample> samples, std::span<const std::size_t> breaks,
                     const TrajectoryRules& rules);

    /// State at `time` s of playing time; constant before 0 and after the end. `hint` is the result of the last call;
    /// it makes forward playing constant-time and does not change the result.
    TrajectoryState at(double time, std::size_t& hint) const noexcept;

    double duration() const noexcept { return spans_.empty() ? 0.0 : spans_.back().end; }
    std::size_t gaps() const noexcept { return gaps_; }
    const Pose& start() const noexcept { return start_; }

private:
    static constexpr std::size_t channels = 7;  // x y z, w x y z
    struct Knot {
        double value[channels];
        double second[channels];  // second derivative, per s²
    };
    /// A piece of playing time: a spline interval between two knots, a hold (equal knots) or an easing.
    struct Piece {
        double begin = 0.0, end = 0.0;
        std::size_t knot = 0;  // from knot to knot + 1
        enum Kind { spline, hold, ease } kind = spline;
    };

    void fit(std::size_t first, std::size_t last, std::span<const TrajectorySample> samples);
    void cross(std::size_t knot, double& clock, double recorded, const TrajectoryRules& rules);
    Intention on(const Piece& piece, double time) const noexcept;

    std::vector<Knot> knots_;
    std::vector<Piece> spans_;
    Pose start_;
    std::size_t gaps_ = 0;
};

}  // namespace tactus::simulate
