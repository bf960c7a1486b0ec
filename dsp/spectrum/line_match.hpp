// SPDX-License-Identifier: Apache-2.0
// The lines of two spectra, and which of them belong together.
#pragma once

#include "dsp/spectrum/welch.hpp"

#include <optional>
#include <vector>

namespace tactus {

/// A line of a spectrum.
struct Line {
    double hz = 0.0;
    double db = 0.0;      ///< of its amplitude, re 1 of the take's unit
    double snr_db = 0.0;  ///< above the median of its neighbourhood
};

/// Lines of a density (Hann window) between two frequencies in Hz that rise 10 dB above their neighbourhood and come
/// within 60 dB of the strongest, by frequency. Place and level from the two highest bins, exact for a single tone.
std::vector<Line> find_lines(const Spectrum& density, double lowest, double highest);

/// The rate of which the lines are multiples, Hz, 0 when there is none between 60 and 400 Hz: the lowest at which the
/// orders up to 1 kHz are on average nearly as strong as at the best.
double fundamental_of(const std::vector<Line>& lines, double highest);

/// Largest deviation of the orders' level differences from their mean, dB: orders of the two fundamentals up to
/// `highest` that stand 6 dB above their neighbourhood in the reference. None with fewer than 2 of them.
std::optional<double> harmonic_error(const Spectrum& reference, double reference_hz, const Spectrum& output,
                                     double output_hz, double highest);

struct MatchedLines {
    std::vector<Line> in_both;            ///< as the reference has them
    std::vector<Line> only_in_reference;  ///< and the output, with its gain, is 6 dB softer there
    std::vector<Line> only_in_output;     ///< and the reference is 6 dB softer there
};

/// Lines match within 0.3 % or two bins, whichever is more, at their own frequencies or at equal speed: `speed_ratio` is
/// the output's over the reference's. `gain` multiplies the output's amplitudes.
MatchedLines match_lines(const Spectrum& reference, const Spectrum& output, double gain, double speed_ratio,
                         double lowest, double highest);

}  // namespace tactus
