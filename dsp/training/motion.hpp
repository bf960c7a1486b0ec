// SPDX-License-Identifier: Apache-2.0
// How a hand moved and pressed during a cut.
#pragma once

#include "dsp/training/planned_cut.hpp"
#include "dsp/training/removed.hpp"

#include <optional>
#include <span>
#include <vector>

namespace tactus::training {

/// One instant of an attempt.
struct AttemptSample {
    double time = 0.0;  ///< s; rising
    Pose pose;          ///< of the blade, scene axes
    Vec3 force{0.0, 0.0, 0.0};  ///< on the hand, N
    bool contact = false;       ///< the blade touches the bone
};

struct MotionMeasures {
    double begin = 0.0, end = 0.0;  ///< s: first and last touch; equal when there was none
    double contact = 0.0;           ///< s: time of contact
    /// s: of it, when the hand was given no force for 0.05 s of contact or more: after a fault, or before engagement.
    double without_force = 0.0;
    double mean_force = 0.0;  ///< N, over the time of contact
    double max_force = 0.0;  ///< N
    double over_limit = 0.0;  ///< N s: integral of the force beyond the limit
    std::optional<double> jerk;  ///< see jerk_of; none without movement
    int strokes = 0;  ///< to and fro
    double path = 0.0;  ///< m, of the middle of the tooth edge between first and last touch
};

/// Positions are resampled to even steps and filtered (low_pass below). A stroke is a movement to and fro along the
/// planned stroke: reversals that are at least 2 mm apart. `force_limit` infinite: none.
MotionMeasures motion_of(std::span<const AttemptSample> samples, const PlannedCut& cut, double force_limit);

/// Even samples of positions.
struct Track {
    double begin = 0.0, step = 1e-3;  ///< s
    std::vector<Vec3> position;  ///< m
};

/// The positions in even steps (the median of the samples' own), by linear interpolation, then filtered forwards and
/// backwards by a Butterworth low-pass of second order: no delay, -6 dB at `cutoff` Hz. The track is extended by its
/// ends, so that a movement that has begun does not ring.
Track low_pass(std::span<const AttemptSample> samples, double cutoff = 20.0);

/// Indices of the reversals along `axis` that are at least `least` m apart, including both ends of the range.
std::vector<std::size_t> reversals_of(const Track& track, std::size_t first, std::size_t last, const Vec3& axis,
                                      double least);

/// Log dimensionless jerk of the movement from sample `first` to `last`: ln(T³/v² ∫ |jerk|² dt), T the duration, v the
/// highest speed. Greater is less smooth: the negative of LDLJ of Balasubramanian et al. 2015 (J NeuroEng Rehabil 12,
/// 112), after Hogan and Sternad 2009 (J Mot Behav 41, 529). 5.32 for a movement of minimum jerk from rest to rest,
/// 3.89 for half a period of a sine. None for less than eight samples or without movement.
std::optional<double> log_dimensionless_jerk(const Track& track, std::size_t first, std::size_t last);

/// Beyond the far side of a bone.
struct Breakthrough {
    double depth = 0.0;  ///< m: how far the tooth edge went beyond the deepest bone of the cut
    double speed = 0.0;  ///< m/s: highest speed along the feed from there to the deepest point of that plunge
};

/// `bone` is what the cut went through: see Severance. None when the blade did not pass its far side.
std::optional<Breakthrough> breakthrough_of(std::span<const AttemptSample> samples, const PlannedCut& cut,
                                            const BladeSize& blade, const Severance& bone);

}  // namespace tactus::training
