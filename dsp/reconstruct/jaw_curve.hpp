// SPDX-License-Identifier: Apache-2.0
// From a curve along the jaw to straight segments.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::reconstruct {

/// Straight segments from joint to joint in place of a curve.
struct CurveSplit {
    std::vector<Vec3> joints;  ///< on the curve, ends included; one more than segments
    double rms = 0.0;  ///< m: distance of the curve from its segments
    double greatest = 0.0;  ///< m
};

/// The split of least rms among all with joints on the curve and no segment shorter than `least_segment`, to about
/// 0.25 mm: dynamic programming over candidates along the curve (as of Perez and Vidal 1994), which has no start and no
/// local minima. `curve`: at least two points, joined by straight lines. Throws Error when nothing satisfies this.
CurveSplit split_curve(std::span<const Vec3> curve, std::size_t segments, double least_segment);

/// The same measures for given joints: places along the curve, m, rising, without its ends.
CurveSplit split_at(std::span<const Vec3> curve, std::span<const double> places);

}  // namespace tactus::reconstruct
