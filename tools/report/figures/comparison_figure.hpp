// SPDX-License-Identifier: Apache-2.0
// Draws a comparison of two vibrations.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/comparison.hpp"

#include <string>

namespace tactus::report {

/// Both spectra with named lines and the limit of touch, errors of the third-octave bands against the threshold,
/// coherence and both spectrograms if available, and a table of scores.
display::Figure draw_comparison(const analysis::ComparedPair& pair);

/// Writes a figure as .svg or .png, by extension. Throws Error.
void write_figure(const display::Figure& figure, const std::string& path);

}  // namespace tactus::report
