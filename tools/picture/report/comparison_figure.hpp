// SPDX-License-Identifier: Apache-2.0
// A comparison as a figure for print.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/study/vibration/comparison.hpp"

#include <string>

namespace tactus::picture {

/// Both spectra with their lines marked and named and the limit of touch, errors of the third-octave bands against the
/// threshold, coherence when there is one, both spectrograms when the pair has them, and a table of scores.
display::Figure draw_comparison(const study::ComparedPair& pair);

/// Writes a figure as the name's ending says: .svg or .png. Throws Error.
void write_figure(const display::Figure& figure, const std::string& path);

}  // namespace tactus::picture
