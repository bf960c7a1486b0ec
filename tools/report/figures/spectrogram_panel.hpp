// SPDX-License-Identifier: Apache-2.0
// A spectrogram in a figure.
#pragma once

#include "devices/display/figure.hpp"
#include "dsp/signal/spectrum/spectrogram.hpp"

namespace tactus::report {

/// The plot area, in units of the figure; axes and legend lie outside.
struct SpectrogramPlace {
    double x, y, width, height;
};

struct SpectrogramStyle {
    double lowest, highest;        ///< Hz, logarithmic upwards
    int rows = 110, columns = 320; ///< cells at most
    bool legend = true;
    bool relative = false;         ///< the legend is in dB re the maximum
    double begin = 0.0;            ///< s: time of the left end
    double reference = 1.0;        ///< rms in the record's unit that has 0 dB
};

/// Draws levels from the maximum to 60 dB below it; time from left to right.
void draw_spectrogram(display::Figure& figure, const signal::Spectrogram& spectrogram, const SpectrogramPlace& place,
                      const SpectrogramStyle& style);

}  // namespace tactus::report
