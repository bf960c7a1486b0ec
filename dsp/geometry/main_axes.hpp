// SPDX-License-Identifier: Apache-2.0
// Principal axes of a point set.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tactus::geometry {

/// Eigenvectors of a symmetric matrix as the columns of a rotation, that of the greatest eigenvalue first.
inline Mat3 main_axes(const Mat3& spread) noexcept {
    std::array<double, 9> m{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            m[3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)] = spread[column][row];
    const SymmetricEigen<3> eigen = symmetric_eigen<3>(m);
    Mat3 axes(1.0);
    for (int n = 0; n < 3; ++n) {
        const auto& v = eigen.vector[static_cast<std::size_t>(2 - n)];
        axes[n] = Vec3(v[0], v[1], v[2]);
    }
    if (glm::determinant(axes) < 0.0) axes[2] = -axes[2];
    return axes;
}

}  // namespace tactus::geometry
