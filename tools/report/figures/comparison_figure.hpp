// SPDX-License-Identifier: Apache-2.0
// Draws a comparison of two vibrations.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/comparison.hpp"

namespace tactus::report {

/// Both spectra with named lines and the limit of touch, errors of the third-octave bands against the threshold,
/// coherence and both spectrograms if available, and a table of scores.
display::Figure draw_comparison(const analysis::ComparedPair& pair);

}  // namespace tactus::report
