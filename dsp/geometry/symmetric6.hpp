// SPDX-License-Identifier: Apache-2.0
// Solver for symmetric positive semidefinite 6 × 6 systems: three translations and three rotations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::geometry {

using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<double, 36>;  ///< row by row

/// Solves k x = b by LDLᵀ without pivoting. Adds 1e-9 of the largest diagonal entry of each kind (translations,
/// rotations) to the diagonal: unconstrained directions then stay at rest, and a singular matrix gives a finite x.
/// Returns false, with x = 0, when the matrix is still not positive or not finite.
inline bool solve_symmetric6(Matrix6 k, const Vector6& b, Vector6& x) noexcept {
    for (std::size_t block = 0; block < 6; block += 3) {
        double greatest = 1e-3;
        for (std::size_t i = block; i < block + 3; ++i) greatest = std::max(greatest, k[7 * i]);
        for (std::size_t i = block; i < block + 3; ++i) k[7 * i] += 1e-9 * greatest;
    }
    x = b;
    // Column by column: L replaces the part of k below the diagonal, D the diagonal.
    for (std::size_t j = 0; j < 6; ++j) {
        const double pivot = k[7 * j];
        if (!(pivot > 0.0) || !std::isfinite(pivot)) {
            x = {};
            return false;
        }
        for (std::size_t i = j + 1; i < 6; ++i) {
            const double l = k[6 * i + j] / pivot;
            for (std::size_t n = j + 1; n <= i; ++n) k[6 * i + n] -= l * k[6 * n + j];
            x[i] -= l * x[j];
        }
        for (std::size_t i = j + 1; i < 6; ++i) k[6 * i + j] /= pivot;
    }
    for (std::size_t i = 6; i-- > 0;) {
        x[i] /= k[7 * i];
        for (std::size_t n = i + 1; n < 6; ++n) x[i] -= k[6 * n + i] * x[n];
    }
    for (const double v : x)
        if (!std::isfinite(v)) {
            x = {};
            return false;
        }
    return true;
}

}  // namespace tactus::geometry
