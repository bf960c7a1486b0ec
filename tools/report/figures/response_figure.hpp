// SPDX-License-Identifier: Apache-2.0
// Figure of a frequency response between two channels: level, phase and coherence.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/two_channels.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <filesystem>

namespace tactus::report {

/// Level of the chosen estimate, with H1 and H2 dashed, which bound it where there is noise; phase; coherence. Where the
/// coherence is below one half the curves of level and phase are left out.
display::Figure draw_response(const analysis::TwoChannels& found, const std::filesystem::path& file,
                              const FigureStyle& style = screen_style);

}  // namespace tactus::report
