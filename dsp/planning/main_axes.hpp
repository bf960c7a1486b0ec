// SPDX-License-Identifier: Apache-2.0
// Directions along which points spread most and least.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/snap/hold.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tactus {

/// Eigenvectors of a symmetric matrix as the columns of a rotation, that of the greatest eigenvalue first.
inline Mat3 main_axes(const Mat3& spread) noexcept {
    Matrix6 m{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            m[6 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)] = spread[column][row];
    // The other three stay below whatever the matrix has, so that they come first.
    for (std::size_t n = 3; n < 6; ++n) m[7 * n] = -1.0 - spread[0][0] - spread[1][1] - spread[2][2];
    const Eigen6 eigen = eigen_of(m);
    Mat3 axes(1.0);
    for (int n = 0; n < 3; ++n) {
        const Vector6& v = eigen.vector[static_cast<std::size_t>(5 - n)];
        axes[n] = Vec3(v[0], v[1], v[2]);
    }
    if (glm::determinant(axes) < 0.0) axes[2] = -axes[2];
    return axes;
}

}  // namespace tactus
