// SPDX-License-Identifier: Apache-2.0
// Matches the lines of two spectra.
#pragma once

#include "dsp/signal/spectrum/lines.hpp"

#include <optional>
#include <vector>

namespace tactus::signal {

/// Level of a line's amplitude, dB re 1 of the record's unit.
double level_db(const SpectralLine& line);
/// Level of its root mean square, 3.01 dB less.
double rms_db(const SpectralLine& line);

/// Largest deviation of the orders' level differences from their mean, dB: orders of the two fundamentals up to
/// `highest` that are 6 dB above their neighbourhood in the reference and within 40 dB of its strongest. None with
/// fewer than 2 of them.
std::optional<double> harmonic_error(const Spectrum& reference, double reference_hz, const Spectrum& output,
                                     double output_hz, double highest);

struct MatchedLines {
    std::vector<SpectralLine> in_both;  ///< values of the reference
    std::vector<SpectralLine> only_in_reference;  ///< the output, with its gain, is 6 dB lower there
    std::vector<SpectralLine> only_in_output;  ///< the reference is 6 dB lower there
};

/// Lines within 60 dB of the strongest, by frequency. They match within 0.3 % or two bins, whichever is more, at equal
/// frequencies or equal orders: `speed_ratio` is the output's over the reference's. `gain` multiplies the output's
/// amplitudes.
MatchedLines match_lines(const Spectrum& reference, const Spectrum& output, double gain, double speed_ratio,
                         double lowest, double highest);

}  // namespace tactus::signal
