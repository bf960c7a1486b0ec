// SPDX-License-Identifier: Apache-2.0
// Figure of the waterfall of a machine with a changing rate.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/orders.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <filesystem>

namespace tactus::report {

/// Per channel (at most four): levels as colours over order or frequency, upwards time or speed; beside rows of time, the
/// rate. rms levels down to 60 dB below the strongest; white: above half the sample rate.
display::Figure draw_waterfall(const analysis::Orders& orders, const std::filesystem::path& file,
                               const FigureStyle& style = screen_style);

}  // namespace tactus::report
