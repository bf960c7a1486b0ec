// SPDX-License-Identifier: Apache-2.0
// Spectra of whole records and their inverse, for offline analysis.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Discrete Fourier transform Σ x[n] e^{−2πi kn/size} for k = 0 … size/2 of the zero-padded samples. `size` is even,
/// best a product of small primes, and not below the number of samples. Allocates.
std::vector<std::complex<double>> spectrum_of(std::span<const double> samples, std::size_t size);

/// Real samples from a half spectrum (bins 0 … size/2): the inverse of `spectrum_of`. Allocates.
std::vector<double> samples_of(std::span<const std::complex<double>> half);

}  // namespace tactus::signal
