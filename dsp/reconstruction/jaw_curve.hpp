// SPDX-License-Identifier: Apache-2.0
// Approximates a curve along the jaw by straight segments.
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::reconstruction {

/// Straight segments between joints that approximate a curve.
struct CurveSplit {
    std::vector<Vec3> joints;  ///< on the curve, ends included; one more than segments
    double rms = 0.0;  ///< m: distance of the curve from its segments
    double greatest = 0.0;  ///< m: largest distance
};

/// Returns the split with the smallest rms among those with joints on the curve and no segment shorter than
/// `min_segment`, to about 0.25 mm. Uses dynamic programming over candidates along the curve (as Perez and Vidal
/// 1994), which needs no start and has no local minima. `curve`: at least two points, joined by straight lines. Throws
/// Error if there is no such split.
CurveSplit split_curve(std::span<const Vec3> curve, std::size_t segments, double min_segment);

/// The same measures for given joints: positions along the curve, m, ascending, without its ends.
CurveSplit split_at(std::span<const Vec3> curve, std::span<const double> places);

}  // namespace tactus::reconstruction
