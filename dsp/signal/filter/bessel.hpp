// SPDX-License-Identifier: Apache-2.0
// Modified Bessel function of the first kind, order 0: Kaiser windows are made of it.
#pragma once

namespace tactus::signal {

/// Computed by its series; exact to rounding up to x = 20.
inline double bessel_i0(double x) noexcept {
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 50; ++k) {
        term *= (0.5 * x / k) * (0.5 * x / k);
        sum += term;
    }
    return sum;
}

}  // namespace tactus::signal
