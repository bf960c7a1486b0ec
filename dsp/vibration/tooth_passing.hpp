// SPDX-License-Identifier: Apache-2.0
// The beat of saw teeth that pass an edge of the bone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::vibration {

/// What the cutting front says of its teeth.
struct TeethInBone {
    double force = 0.0;  ///< N along the stroke, of all that bear
    double count = 0.0;  ///< teeth that bear
    double passing = 0.0;  ///< Hz: teeth that pass a place per second at mid-stroke, speed over pitch
};

/// Force on the saw along the stroke, N, less its mean over a tooth. A blade at s = ½·stroke·sin φ, φ the phase of the
/// stroke, has moved by s/pitch teeth, and with each of them one tooth more or less bears: one tooth's share of the force
/// comes and goes with cos(2π s/pitch), against the motion. Its frequency at any time is the speed of the blade over the
/// pitch. `cycles` of the stroke; `rate` of the stroke, Hz. Above `highest` Hz it is silent.
inline double tooth_passing_force(const TeethInBone& teeth, double cycles, double rate, double highest) noexcept {
    if (!(teeth.force > 0.0) || !(teeth.count > 0.0) || !(teeth.passing > 0.0) || !(rate > 1.0)) return 0.0;
    if (!std::isfinite(teeth.force) || !std::isfinite(teeth.passing) || teeth.passing >= highest) return 0.0;
    const double phase = 2.0 * std::numbers::pi * (cycles - std::floor(cycles));
    // 2π·½·stroke/pitch = passing/rate.
    return -teeth.force / std::max(teeth.count, 1.0) * std::cos(phase) *
           std::cos(teeth.passing / rate * std::sin(phase));
}

}  // namespace tactus::vibration
