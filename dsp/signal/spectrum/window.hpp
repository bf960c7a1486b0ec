// SPDX-License-Identifier: Apache-2.0
// Window functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

enum class WindowKind { rectangular, hann, hamming, blackman, blackman_harris, flat_top };

enum class WindowSymmetry {
    periodic,  ///< one period of a function of period n: for spectra
    symmetric,  ///< first and last value are equal: for filter design and fades
};

/// `n` values, largest about 1; the sums of cosines of Harris 1978, flat top as D'Antona and Ferrero 2006. Allocates.
std::vector<double> make_window(WindowKind kind, std::size_t n, WindowSymmetry symmetry = WindowSymmetry::periodic);

/// Equivalent noise bandwidth in bins: n Σw² / (Σw)²; 1.5 for Hann.
double noise_bandwidth_bins(std::span<const double> window);

}  // namespace tactus::signal
