// SPDX-License-Identifier: Apache-2.0
// Sensor models of a gripper: quantisation, noise, and calibration of a strain gauge.
#pragma once

#include "dsp/core/random.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace tactus::simulate {

/// Quantises in steps of `step` after adding normal noise.
struct Quantiser {
    double step = 0.0;   ///< 0: none
    double noise = 0.0;  ///< rms, in the unit of the value
    Random random;

    /// Depends on `value` and `index` only.
    double operator()(double value, std::uint64_t index) const noexcept {
        if (noise > 0.0) value += noise * random.normal(index);
        return step > 0.0 ? step * std::nearbyint(value / step) : value;
    }
};

/// y = slope x + offset by least squares.
struct LineFit {
    double slope = 1.0, offset = 0.0;
    double r_squared = 1.0;  ///< coefficient of determination
    double worst_residual = 0.0;  ///< greatest residual, in the unit of y: nonlinearity

    double operator()(double x) const noexcept { return slope * x + offset; }
};

/// Calibrates a strain gauge from readings under known forces (thesis 6.3.1). Needs two points with different x;
/// otherwise the slope is 0. Sums in the order of the points.
LineFit fit_line(std::span<const double> x, std::span<const double> y) noexcept;

}  // namespace tactus::simulate
