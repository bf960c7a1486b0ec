// SPDX-License-Identifier: Apache-2.0
// Between the float of a signal and the double that filters compute with.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::signal {

/// A sample that is not finite counts as silence: one of them would stay in a filter's state for ever.
inline double finite_or_zero(float x) noexcept { return std::isfinite(x) ? static_cast<double>(x) : 0.0; }

/// What a float can hold of it.
inline float to_sample(double x) noexcept {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -largest, largest));
}

}  // namespace tactus::signal
