// SPDX-License-Identifier: Apache-2.0
// The normal of a plane of the jaw, given or derived.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::reconstruction {

/// Returns the unit normal along the order of the planes, as plan_fibula computes it; for inputs that plan_fibula
/// accepts.
inline Vec3 jaw_normal(const FibulaInputs& inputs, std::size_t plane) {
    const auto axis = [&](std::size_t n) {
        return glm::normalize(inputs.planes[n + 1].origin - inputs.planes[n].origin);
    };
    const bool is_first = plane == 0, is_last = plane + 1 == inputs.planes.size();
    const Vec3 bisector = glm::normalize(axis(is_first ? 0 : plane - 1) + axis(is_last ? plane - 1 : plane));
    const Vec3 normal = inputs.planes[plane].normal ? glm::normalize(*inputs.planes[plane].normal) : bisector;
    return glm::dot(normal, bisector) < 0.0 ? -normal : normal;
}

}  // namespace tactus::reconstruction
