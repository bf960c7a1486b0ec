// SPDX-License-Identifier: Apache-2.0
// Fundamental frequency of a running spectrum: the harmonic sums of `FundamentalStream`, without its path over time.
#pragma once

#include "dsp/signal/spectrum/fundamental.hpp"

namespace tactus::signal {

struct LiveFundamental {
    double frequency = 0.0;   ///< Hz; 0: not periodic
    double confidence = 0.0;  ///< 0 … 1; uncertain below 0.25
};

/// Wait-free, does not allocate. A rate that changes while the spectrum is averaged smears its lines, and is missed.
inline LiveFundamental live_fundamental(HarmonicSummer& summer, const Spectrum& spectrum, double lowest,
                                        double highest) noexcept {
    const std::span<const HarmonicSum> sums = summer(spectrum, lowest, highest);
    const double confidence = confidence_in(sums);
    return confidence < FundamentalEstimate::heard ? LiveFundamental{}
                                                   : LiveFundamental{sums.front().frequency, confidence};
}

}  // namespace tactus::signal
