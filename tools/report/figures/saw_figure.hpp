// SPDX-License-Identifier: Apache-2.0
// Draws the cutting law beside what was measured.
#pragma once

#include "devices/display/figure.hpp"

#include <vector>

namespace tactus::report {

struct SawCurvePoint {
    double x, y;
};

/// What the kernel did, beside the law: feed over thrust (N, mm/s) and thrust over stroke rate at constant feed (Hz, N).
struct SawFigure {
    std::vector<SawCurvePoint> feed, thrust;
};

/// Forces of a tooth over its depth of cut with the published points, feed over thrust, and thrust over the rate of the
/// stroke at the feed of Yu 2023.
display::Figure draw_saw_law(const SawFigure& measured);

}  // namespace tactus::report
