// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/passivity/z_width.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <vector>

namespace tactus::report {

/// Stiffness over damping of a wall, one panel per device: the bound, the passivity border by motion, and where the
/// simulated device begins to oscillate; a colour per rate, dashes with delay.
display::Figure draw_z_width(const std::vector<analysis::ZWidthCurve>& curves, const FigureStyle& style = screen_style);

}  // namespace tactus::report
