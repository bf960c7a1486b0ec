// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/sweep/sweep_statistics.hpp"

namespace tactus::report {

/// A heat map, or lines with intervals, in one panel for each level of the panel's axis. Axes of numbers that span a
/// decade are logarithmic, others linear; texts are in their order. Throws Error when there is no value.
display::Figure draw_sweep(const analysis::FigureData& data);

}  // namespace tactus::report
