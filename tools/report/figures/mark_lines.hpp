// SPDX-License-Identifier: Apache-2.0
// Labelled markers at frequencies of a plot.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/marks.hpp"

#include <functional>
#include <span>

namespace tactus::report {

/// The plot area, in units of the figure, and its range of frequencies.
struct MarkedArea {
    double x, y, width, height;
    double lowest, highest;  ///< Hz
};

/// A dashed line at each place within the range, with its name at the top; names that would overlap move down.
/// `x_of`: Hz → units of the figure.
void draw_marks(display::Figure& figure, const MarkedArea& area, std::span<const analysis::MarkPlace> places,
                const std::function<double(double)>& x_of);

}  // namespace tactus::report
