// SPDX-License-Identifier: Apache-2.0
// Local rational model of a frequency response: resolves resonances that are narrower than an average over frequencies.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

namespace tactus::vibration {

/// Measured response at one frequency. `weight`: reciprocal of the variance of its noise, up to a factor.
struct ResponseBin {
    double hz = 0.0;
    std::complex<double> gain;
    double weight = 0.0;
};

/// H(f) = (b0 + b1 x + b2 x²) / (1 + a1 x) with x = (f − centre) / half_width: one pole, with the rest of the system as a
/// parabola (local rational method: McKelvey and Guérin 2012, Geerardyn, Schoukens and Vandersteen 2013). A polynomial would
/// need many bins within the width of the resonance; the pole needs about ten in all.
struct LocalModel {
    double centre = 0.0, half_width = 1.0;  ///< Hz
    std::array<std::complex<double>, 3> numerator{};
    std::complex<double> denominator = 0.0;  ///< a1
    double residual = 0.0;  ///< weighted mean square of measured less model
    double constant = 0.0;  ///< the same of the best constant
    double bins = 0.0;  ///< effective number of bins
    double pole_deviation = 0.0;  ///< Hz, standard deviation of the pole in each direction

    std::complex<double> operator()(double hz) const;
    /// Resonance as a complex frequency, Hz: f0 √(1 − ζ²) + i ζ f0.
    std::complex<double> pole() const { return centre - half_width / denominator; }
    double frequency() const { return std::abs(pole()); }
    double damping() const { return pole().imag() / std::abs(pole()); }
    /// True if the pole is stable and the model explains significantly more than a constant (F test, about 1e-6).
    bool is_significant() const;
};

/// Weighted least squares: four rounds by Sanathanan and Koerner (1963), then Gauss–Newton steps. `oversampling`:
/// number of bins per independent bin, due to zero padding. A model with fewer than 8 independent bins is not
/// significant. Does not allocate.
LocalModel fit_local_model(std::span<const ResponseBin> bins, double centre, double half_width,
                           double oversampling = 1.0);

}  // namespace tactus::vibration
