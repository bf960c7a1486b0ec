// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace tactus::library {

/// Rises from 0 at 0 to 1 at 1, with zero slope at both ends.
inline double smooth_step(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

}  // namespace tactus::library
