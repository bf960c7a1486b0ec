// SPDX-License-Identifier: Apache-2.0
// The components common to two vibrations above their noise; without this restriction, a comparison would compare noise
// floors.
#pragma once

#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/line_match.hpp"

#include <vector>

namespace tactus::signal {

/// Third-octave bands between `lowest` and `highest` Hz whose density is at least 6 dB above the mean level of the
/// bands one octave below and above (near a limit, of the last band). White noise has none, and neither has noise whose
/// density follows a power of the frequency.
std::vector<Band> bands_above_noise(const Spectrum& density, double lowest, double highest);

struct AboveNoise {
    std::size_t in_reference = 0, in_output = 0;  ///< lines and bands
    /// Hz: lines and bands of both, not more than 20 dB below the strongest of the reference.
    std::vector<double> in_both;
};

/// `lines`: the matched lines of the two spectra.
AboveNoise above_noise(const Spectrum& reference, const Spectrum& output, const MatchedLines& lines, double lowest,
                       double highest);

}  // namespace tactus::signal
