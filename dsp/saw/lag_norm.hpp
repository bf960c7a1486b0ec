// SPDX-License-Identifier: Apache-2.0
// Energy of a family of springs whose stiffness stays bounded however many of them are stretched.
#pragma once

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

/// Stiffness of one spring: k·(u_i²/‖u‖₈²)³.
inline double spring8(double k, double square, double squared_norm) noexcept {
    const double r = square / squared_norm;
    return k * r * r * r;
}

}  // namespace tactus::saw
