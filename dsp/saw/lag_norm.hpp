// SPDX-License-Identifier: Apache-2.0
// Energy of a family of springs whose stiffness stays bounded however many of them are stretched.
#pragma once

#include "dsp/saw/hand_limits.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tactus::saw {

/// ½·k·‖u‖₈² over the lengths u_i: the force of spring i is k·(u_i/‖u‖₈)⁶·u_i. Grows with every u_i; conservative.
/// `squares`: of the lengths, m². Returns ‖u‖₈², m².
inline double squared_norm8(std::span<const double> squares) noexcept {
    double most = 0.0;
    for (const double s : squares) most = std::max(most, s);
    if (!(most > 0.0)) return 0.0;
    double sum = 0.0;
    for (const double s : squares) {
        const double r = s / most, r2 = r * r;
        sum += r2 * r2;
    }
    return most * std::sqrt(std::sqrt(sum));
}

/// A spring whose force stops growing at the length L = max_lag has the energy ½·l² up to there and L·l − ½·L² beyond.
/// Twice that is the square that counts in the norm; `square`: l², m².
inline double saturated_square(double square) noexcept {
    constexpr double most = max_lag * max_lag;
    return square <= most ? square : 2.0 * max_lag * std::sqrt(square) - most;
}

/// Force of such a spring over that of one that does not saturate.
inline double saturation_share(double square) noexcept {
    return square <= max_lag * max_lag ? 1.0 : max_lag / std::sqrt(square);
}

/// Stiffness of one spring: k·(u_i²/‖u‖₈²)³.
inline double spring8(double k, double square, double squared_norm) noexcept {
    const double r = square / squared_norm;
    return k * r * r * r;
}

}  // namespace tactus::saw
