// SPDX-License-Identifier: Apache-2.0
// Whether two takes were made at the same time, and by how much one lags the other.
#pragma once

#include <span>

namespace tactus::signal {

struct Alignment {
    bool significant = false;   ///< the takes belong together; the rest has a meaning only then
    double delay = 0.0;         ///< s by which the output lags the reference
    double correlation = 0.0;   ///< of the waveforms at that delay, −1 to 1; negative: opposite polarity
    double significance = 0.0;  ///< height of the whitened correlation's peak, in standard deviations of chance
};

/// Looks for the delay, up to ±`longest` s, in the whitened cross-correlation of the band from `lowest` to `highest` Hz
/// (Knapp and Carter 1976). There, every frequency that rises above −60 dB of the strongest counts alike, so two takes of
/// the same few lines do not pass for one take: chance gives a known distribution, of which the peak must stand out at
/// odds of about 1 to 1000, the number of delays accounted for. The delay itself is where the waveforms correlate best
/// within 5 ms of that peak. Both at `rate` Hz. Allocates.
Alignment align_takes(std::span<const double> reference, std::span<const double> output, double rate, double lowest,
                      double highest, double longest);

}  // namespace tactus::signal
