// SPDX-License-Identifier: Apache-2.0
// Linear prediction: a signal as white noise through an all-pole filter 1/A(z), A(z) = 1 + a₁ z⁻¹ + … + aₚ z⁻ᵖ.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Reflection coefficients k₁ … kₚ by Burg's method (Burg 1975; Kay, Modern Spectral Estimation, 1988, 7.5), each below
/// 1 in magnitude, so that the filter is stable. Throws Error when the record is not longer than twice the order. A
/// silent record gives zeros. Allocates.
std::vector<double> burg(std::span<const double> record, std::size_t order);

/// Returns a₁ … aₚ for reflection coefficients (Levinson's recursion). `predictor` has their length. Does not allocate.
void predictor_of(std::span<const double> reflection, std::span<double> predictor) noexcept;

/// Converts a₁ … aₚ to reflection coefficients (the recursion backwards), in place. Returns false if the filter is not
/// stable; the values are then invalid. Does not allocate for orders up to 64, the maximum.
bool reflection_of(std::span<double> predictor) noexcept;

/// Mean square of the filter's output for white noise of mean square 1: ∏ 1 / (1 − k²).
double prediction_gain(std::span<const double> reflection) noexcept;

constexpr std::size_t max_prediction_order = 64;

}  // namespace tactus::signal
