// SPDX-License-Identifier: Apache-2.0
// Cepstrum: families of equally spaced lines (orders, side bands) become one peak at the reciprocal of their spacing.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <vector>

namespace tactus::signal {

struct Cepstrum {
    std::vector<double> value;  ///< of the quefrencies 0 to half of the segment
    double step = 0.0;          ///< s between them

    double quefrency(std::size_t k) const { return static_cast<double>(k) * step; }
};

/// Real cepstrum, the inverse Fourier transform of the natural logarithm of a power spectrum (Bogert, Healy and Tukey
/// 1963). Use an averaged spectrum, so that noise does not hide weak families. Bins below 1e-20 of the strongest count
/// as that. Allocates.
Cepstrum real_cepstrum(const Spectrum& spectrum);

struct CepstralPeak {
    double quefrency = 0.0;  ///< s
    double value = 0.0;

    double frequency() const { return 1.0 / quefrency; }  ///< Hz, spacing of the lines
};

/// Returns at most `count` of the strongest peaks from 8 steps to a quarter of the segment, by descending value: those
/// above 2.5 times the median of that range, except multiples of another peak at least half as high. The peaks are
/// those of an envelope, the root of a weighted mean of squares over 11 steps. The envelope is needed because side
/// bands of a carrier that is not a multiple of their spacing have a cepstrum that crosses zero at the spacing's
/// quefrency, with misleading positive values beside it.
std::vector<CepstralPeak> cepstral_peaks(const Cepstrum& cepstrum, std::size_t count);

}  // namespace tactus::signal
