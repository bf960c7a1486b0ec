// SPDX-License-Identifier: Apache-2.0
// Detects whether two takes were recorded simultaneously, and their delay.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::signal {

struct Alignment {
    bool significant = false;  ///< the takes are simultaneous; the other members are valid only then
    double delay = 0.0;         ///< s by which the output lags the reference
    double correlation = 0.0;  ///< of the waveforms at that delay, −1 to 1; negative: opposite polarity
    double significance = 0.0;  ///< height of the whitened correlation's peak in standard deviations of chance
};

/// Finds the delay, up to ±`longest` s, in the whitened cross-correlation of the band from `lowest` to `highest` Hz
/// (Knapp and Carter 1976). All frequencies above −60 dB of the strongest have equal weight, so that two takes with the
/// same few lines do not match by them alone. Chance then has a known distribution, and the peak must exceed it at odds
/// of about 1 to 1000, corrected for the number of delays. If the whole records show no peak, blocks of one are
/// searched in the whole other one. This finds an excerpt at any position, if at least 1 s and a quarter of the shorter
/// record overlap. The result is the best correlation of the waveforms within 5 ms of that peak, over their overlap.
/// Both at `rate` Hz. Allocates.
Alignment align_takes(std::span<const double> reference, std::span<const double> output, double rate, double lowest,
                      double highest, double longest);

/// Returns the index in the periodic `loop` at which it is most similar to `part`, which must not be longer: the peak
/// of the circular correlation in the band from `lowest` to `highest` Hz. It uses half the whitening of `align_takes`,
/// so that neither a single line nor noise dominates. Both at `rate` Hz. Allocates.
std::size_t stretch_of_loop(std::span<const double> loop, std::span<const double> part, double rate, double lowest,
                            double highest);

}  // namespace tactus::signal
