// SPDX-License-Identifier: Apache-2.0
// Gain and soft limit of a force: the direction stays, the magnitude saturates smoothly.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

/// Magnitudes up to `straight` pass; larger ones approach `most` with a continuous slope. Hard limit if `most` ≤
/// `straight`.
inline double soft_limit(double size, double straight, double most) noexcept {
    if (!(size > std::min(straight, most))) return size;
    if (!(most > straight)) return most;
    return most - (most - straight) * std::exp(-(size - straight) / (most - straight));
}

inline Vec3 soft_limit(const Vec3& v, double straight, double most) noexcept {
    const double size = glm::length(v);
    return size > 0.0 ? v * (soft_limit(size, straight, most) / size) : v;
}

}  // namespace tactus::coupling
