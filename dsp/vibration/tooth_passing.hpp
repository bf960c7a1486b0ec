// SPDX-License-Identifier: Apache-2.0
// Force variation caused by saw teeth that pass an edge of the bone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::vibration {

/// State of the teeth at the cutting front.
struct TeethInBone {
    double force = 0.0;  ///< N along the stroke, sum over the loaded teeth
    double count = 0.0;  ///< number of loaded teeth
    double passing = 0.0;  ///< Hz: teeth that pass a point per second at mid-stroke, speed over pitch
};

/// Force on the saw along the stroke, N, minus its mean over a tooth. A blade at s = ½·stroke·sin φ, where φ is the
/// phase of the stroke, has moved by s/pitch teeth. With each tooth the number of loaded teeth changes by one, so that
/// the force of one tooth varies with cos(2π s/pitch), against the motion. The frequency at any time is the speed of
/// the blade divided by the pitch. `cycles`: of the stroke; `rate`: of the stroke, Hz. The force is 0 if the tooth
/// frequency is above `highest` Hz.
inline double tooth_passing_force(const TeethInBone& teeth, double cycles, double rate, double highest) noexcept {
    if (!(teeth.force > 0.0) || !(teeth.count > 0.0) || !(teeth.passing > 0.0) || !(rate > 1.0)) return 0.0;
    if (!std::isfinite(teeth.force) || !std::isfinite(teeth.passing) || teeth.passing >= highest) return 0.0;
    const double phase = 2.0 * std::numbers::pi * (cycles - std::floor(cycles));
    // 2π·½·stroke/pitch = passing/rate.
    return -teeth.force / std::max(teeth.count, 1.0) * std::cos(phase) *
           std::cos(teeth.passing / rate * std::sin(phase));
}

}  // namespace tactus::vibration
