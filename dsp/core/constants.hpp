// SPDX-License-Identifier: Apache-2.0
// Numbers that many files need. A factor turns a value in its unit into one in SI units: 3.0 * mm is 0.003 m.
#pragma once

#include <limits>
#include <numbers>

namespace tactus {

using std::numbers::pi;

inline constexpr double mm = 1e-3;  // m
inline constexpr double degree = pi / 180.0;  // rad
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace tactus
