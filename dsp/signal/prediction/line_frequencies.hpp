// SPDX-License-Identifier: Apache-2.0
// Line spectral frequencies of a predictor (Itakura 1975). The mean of the line frequencies of stable filters gives a
// stable filter; the mean of predictors may not.
#pragma once

#include <span>
#include <vector>

namespace tactus::signal {

/// The p line spectral frequencies of a₁ … aₚ, rising, in (0, π) rad per sample; p is even. Throws Error when the
/// filter is not stable. Allocates.
std::vector<double> line_frequencies(std::span<const double> predictor);

/// a₁ … aₚ of line spectral frequencies; p is even, at most 64. `predictor` has the same length. Does not allocate.
void predictor_of_lines(std::span<const double> lines, std::span<double> predictor) noexcept;

}  // namespace tactus::signal
