// SPDX-License-Identifier: Apache-2.0
// Gap and contact between two placed bones, measured on both surfaces.
#pragma once

#include "dsp/fit/gap.hpp"
#include "dsp/fit/overlap.hpp"

namespace tactus::fit {

struct MutualGap {
    double facing = 0.0, contact = 0.0;  ///< m², the mean of the two surfaces' areas
    double median = 0.0, p95 = 0.0;  ///< m, signed distances over the facing area of both; positive: gap
    double deepest = 0.0;  ///< m, greatest depth of a point of either inside the other
};

/// Measures each surface against the other bone's distances (see gap_between), so that the result is the same in
/// either order. The two poses of each bone must be equal.
MutualGap mutual_gap(const PlacedBone& a, const PlacedBone& b, const GapSettings& settings = {});

}  // namespace tactus::fit
