// SPDX-License-Identifier: Apache-2.0
// Cholesky's factorisation of a symmetric matrix whose elements lie near the diagonal: a chain of points in which each
// one depends on the two before it.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::rope {

/// A symmetric positive matrix of 3×3 blocks; blocks more than two apart are 0. Memory is taken by the constructor.
class BlockBand {
public:
    explicit BlockBand(std::size_t points) : size_(3 * points), columns_(size_ + width) {}

    void clear() noexcept {
        for (auto& column : columns_) column.fill(0.0);
    }
    /// Adds to block (i, j), i - j = 0, 1 or 2, and to its mirror image.
    void add(std::size_t i, std::size_t j, const Mat3& block) noexcept {
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t a = i == j ? b : 0; a < 3; ++a)
                columns_[3 * j + b][3 * (i - j) + a - b] += block[static_cast<int>(b)][static_cast<int>(a)];
    }
    void add(std::size_t i, std::size_t j, double diagonal) noexcept {
        for (std::size_t a = 0; a < 3; ++a) columns_[3 * j + a][3 * (i - j)] += diagonal;
    }
    /// Makes the equations of point i read x = right side; the right side must be 0.
    void fix(std::size_t i) noexcept {
        for (std::size_t a = 3 * i; a < 3 * i + 3; ++a) {
            columns_[a].fill(0.0);
            columns_[a][0] = 1.0;
            for (std::size_t k = 1; k <= std::min(a, width); ++k) columns_[a - k][k] = 0.0;
        }
    }
    /// Solves for `x`, which holds the right side; the matrix is overwritten by its factors L D Lᵀ. False when it is
    /// not positive.
    bool solve(std::vector<Vec3>& x) noexcept {
        for (std::size_t i = 0; i < size_; ++i) {
            auto& pivot = columns_[i];
            if (!(pivot[0] > 0.0) || !std::isfinite(pivot[0])) return false;
            const double inverse = 1.0 / pivot[0];
            for (std::size_t r = 1; r <= width; ++r) {
                const double factor = pivot[r] * inverse;
                double* const to = columns_[i + r].data();
                const double* const from = pivot.data() + r;
                for (std::size_t s = 0; s < width; ++s) to[s] -= factor * from[s];
            }
            for (std::size_t r = 1; r <= width; ++r) pivot[r] *= inverse;
            pivot[0] = inverse;
        }
        double* const v = &x[0].x;
        for (std::size_t i = 0; i < size_; ++i)
            for (std::size_t k = 1; k < std::min(width + 1, size_ - i); ++k) v[i + k] -= columns_[i][k] * v[i];
        for (std::size_t i = size_; i-- > 0;) {
            double sum = v[i] * columns_[i][0];
            for (std::size_t k = 1; k < std::min(width + 1, size_ - i); ++k) sum -= columns_[i][k] * v[i + k];
            v[i] = sum;
        }
        return true;
    }

private:
    static constexpr std::size_t width = 8;  // elements of a column below the diagonal
    std::size_t size_;
    // Element k of column j: row j + k. The second half stays 0, so that loops have one length.
    std::vector<std::array<double, 2 * width>> columns_;
};
static_assert(sizeof(Vec3) == 3 * sizeof(double));

}  // namespace tactus::rope
