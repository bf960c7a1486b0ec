// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_bounds.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::control {

Vec3 shorten(const Vec3& v, double length) noexcept {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest == 0.0) return v;
    const Vec3 unit = v / largest;
    const double excess = glm::length(unit) * largest / length;
    return excess > 1.0 ? unit * (length / glm::length(unit)) : v;
}

Wrench ForceBounds::clamp(const Wrench& wanted) const noexcept {
    if (!is_finite(wanted)) return {};
    return {shorten(wanted.force, force), shorten(wanted.torque, torque)};
}

}  // namespace tactus::control
