// SPDX-License-Identifier: Apache-2.0
// Figure of spectrum and spectrogram per channel.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/study/vibration/spectrum_analysis.hpp"

namespace tactus::picture {

/// Per channel (at most four): the spectrum with named lines and the limit of touch, and the spectrogram below it if
/// available.
display::Figure draw_spectrum(const study::AnalysedFile& file);

}  // namespace tactus::picture
