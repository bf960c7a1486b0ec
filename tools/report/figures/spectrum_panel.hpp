// SPDX-License-Identifier: Apache-2.0
// Plots of spectra: over a logarithmic frequency, and of envelopes over a linear one.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"
#include "tools/analysis/vibration/level_reference.hpp"
#include "tools/report/figures/mark_lines.hpp"
#include "tools/report/figures/plot_panel.hpp"

#include <span>
#include <string>

namespace tactus::report {

struct SpectrumCurve {
    const signal::Spectrum* spectrum = nullptr;
    analysis::LevelReference reference;
    display::Colour colour;
    double dash = 0.0, width = 1.3;
};

struct DrawnSpectra {
    PlotPanel panel;
    double lowest, highest;  ///< dB, of the axis
};

/// Curves, axes from the strongest value down to the weakest, 40 to 80 dB, the limit of touch, marks. `unit`: of the levels.
DrawnSpectra draw_spectra(display::Figure& figure, const MarkedArea& area, std::span<const SpectrumCurve> curves,
                          const std::string& unit, std::span<const analysis::MarkPlace> marks);

/// Spectra of envelopes from 0 Hz to `area.highest`, 30 to 60 dB deep, and marks.
void draw_envelopes(display::Figure& figure, const MarkedArea& area, std::span<const SpectrumCurve> curves,
                    const std::string& title, const std::string& unit, std::span<const analysis::MarkPlace> marks);

/// Hz: where a plot of envelopes of a band ends: half the width of the band, or a little above the highest mark.
double end_of_envelope(std::pair<double, double> band, std::span<const analysis::MarkPlace> marks);

/// Level of the strongest of three bins at a frequency, dB.
double level_at(const SpectrumCurve& curve, double hz);

}  // namespace tactus::report
