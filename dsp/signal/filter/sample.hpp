// SPDX-License-Identifier: Apache-2.0
// Conversion between the float of a signal and the double of filters.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::signal {

/// A non-finite sample becomes 0: it would stay in a filter's state for ever.
inline double finite_or_zero(float x) noexcept { return std::isfinite(x) ? static_cast<double>(x) : 0.0; }

/// Clamps to the range of a float.
inline float to_sample(double x) noexcept {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -largest, largest));
}

}  // namespace tactus::signal
