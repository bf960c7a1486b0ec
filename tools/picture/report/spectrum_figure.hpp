// SPDX-License-Identifier: Apache-2.0
// A channel's spectrum and spectrogram as a figure for print.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/study/vibration/spectrum_analysis.hpp"

namespace tactus::picture {

/// Per channel (at most four): the spectrum with its lines named and the limit of touch, and the spectrogram below it
/// when it was made.
display::Figure draw_spectrum(const study::AnalysedFile& file);

}  // namespace tactus::picture
