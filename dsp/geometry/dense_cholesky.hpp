// SPDX-License-Identifier: Apache-2.0
// Solver for dense symmetric positive systems of any size.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::geometry {

/// Solves matrix · x = right by Cholesky's factorisation; `right` becomes x. `matrix` (row by row, its lower triangle
/// is used) is overwritten. Returns false, with both undefined, when the matrix is not positive or not finite.
inline bool solve_positive(std::vector<double>& matrix, std::vector<double>& right) {
    const std::size_t size = right.size();
    for (std::size_t j = 0; j < size; ++j) {
        double* row_j = matrix.data() + j * size;
        for (std::size_t i = j; i < size; ++i) {
            double* row_i = matrix.data() + i * size;
            double sum = row_i[j];
            for (std::size_t k = 0; k < j; ++k) sum -= row_i[k] * row_j[k];
            if (i > j) {
                row_i[j] = sum / row_j[j];
                continue;
            }
            if (!(sum > 0.0) || !std::isfinite(sum)) return false;
            row_j[j] = std::sqrt(sum);
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < i; ++k) right[i] -= matrix[i * size + k] * right[k];
        right[i] /= matrix[i * size + i];
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) right[i] -= matrix[k * size + i] * right[k];
        right[i] /= matrix[i * size + i];
    }
    return true;
}

}  // namespace tactus::geometry
