// SPDX-License-Identifier: Apache-2.0
// Adjoint transform of a fit's energy to another reference point and other axes.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::fit {

/// Transforms the sum to another reference point and other axes: `arm` leads from the new point to the old one, in new
/// axes; `rotation` maps old axes to new ones.
inline contact::ContactSum adjoint_transform(const contact::ContactSum& sum, const Mat3& rotation, const Vec3& arm,
                                             double share) noexcept {
    // Motion of the old frame from that of the new one: v' = rotationᵀ (v + ω × arm), ω' = rotationᵀ ω.
    geometry::Matrix6 motion{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const Vec3 axis(column == 0, column == 1, column == 2), old = rotation[row];
            const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
            motion[6 * r + c] = motion[6 * (r + 3) + c + 3] = glm::dot(old, axis);
            motion[6 * r + c + 3] = glm::dot(old, glm::cross(axis, arm));
        }
    contact::ContactSum out;
    geometry::Matrix6 half{};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            out.gradient[i] += share * motion[6 * j + i] * sum.gradient[j];
            for (std::size_t k = 0; k < 6; ++k) half[6 * i + j] += sum.stiffness[6 * i + k] * motion[6 * k + j];
        }
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i; j < 6; ++j) {
            double entry = 0.0;
            for (std::size_t k = 0; k < 6; ++k) entry += motion[6 * k + i] * half[6 * k + j];
            out.stiffness[6 * i + j] = out.stiffness[6 * j + i] = share * entry;
        }
    out.energy = share * sum.energy;
    return out;
}

}  // namespace tactus::fit
