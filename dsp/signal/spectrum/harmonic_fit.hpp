// SPDX-License-Identifier: Apache-2.0
// Least-squares fit of harmonically related sines to samples: the maximum-likelihood estimate of their common rate in
// white noise.
#pragma once

#include <span>

namespace tactus::signal {

struct HarmonicFit {
    double frequency = 0.0;  ///< Hz
    double deviation = 0.0;  ///< Hz: Cramér–Rao bound, with the noise that the fit leaves
};

/// Gauss–Newton iterations from `frequency`, Hz, which must be within about a third of 1/(duration × highest order).
/// `orders`: the present orders. `others`: frequencies, Hz, of further lines, whose amplitudes are fitted too, as is a
/// constant. The normal equations have closed forms in all frequencies (Dirichlet kernels), so that an iteration costs
/// two correlations per line. Allocates.
HarmonicFit fit_harmonics(std::span<const double> samples, double rate, double frequency, std::span<const int> orders,
                          std::span<const double> others);

}  // namespace tactus::signal
