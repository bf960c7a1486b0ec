// SPDX-License-Identifier: Apache-2.0
// Brightness across a vessel: 1 on its axis, 0 far outside, about one half at its radius.
#pragma once

#include <cmath>

namespace tactus::vessel {

/// A profile and its derivatives.
struct ProfileValue {
    double value;
    double by_squared_distance;  ///< 1/m²
    double by_radius;            ///< 1/m
};

/// Returns r⁸ / (d⁸ + r⁸) for the distance d to the axis (Friman et al., Medical Image Analysis 14, 2010).
inline ProfileValue smooth_profile(double squared_distance, double radius) {
    const double ratio = squared_distance / (radius * radius), fourth = ratio * ratio * ratio * ratio;
    const double p = 1.0 / (1.0 + fourth);
    return {p, -4.0 * ratio * ratio * ratio * p * p / (radius * radius), 8.0 / radius * p * (1.0 - p)};
}

/// Returns the profile of a disc of the radius under a normal blur of standard deviation `blur`: ∫₀ʳ s/q² exp(-(d² +
/// s²) / 2q²) I₀(d s / q²) ds. Interpolated from a table, error below 1e-3.
ProfileValue blurred_profile(double squared_distance, double radius, double blur);
/// Returns its value only. Lengths in m.
double blurred_disc(double distance, double radius, double blur);

}  // namespace tactus::vessel
