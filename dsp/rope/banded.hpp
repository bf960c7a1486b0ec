// SPDX-License-Identifier: Apache-2.0
// Solver for the symmetric system of a chain in which each point is coupled to the two before it, factored from both
// ends.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::rope {

/// A symmetric positive matrix of 3×3 blocks; blocks more than two apart are 0. It is factored as L D Lᵀ from both ends
/// towards two points in the middle (a twisted factorisation): both halves have the same operations and no common
/// element until they meet, so that they are computed as the two lanes of one vector. Only the constructor allocates.
class BlockBand {
public:
    /// Requires at least three points.
    explicit BlockBand(std::size_t points)
        : size_(points), middle_(points > 0 ? (points - 1) / 2 : 0), columns_(middle_ + 2), right_(middle_ + 2) {}

    void clear() noexcept {
        for (Column& c : columns_) c = {};
        // With an odd number of points to eliminate, the second half begins with a decoupled dummy point.
        if (size_ % 2 == 1) columns_[0].diagonal[0][1] = columns_[0].diagonal[3][1] = columns_[0].diagonal[5][1] = 1.0;
    }
    /// Copies the elements of a matrix of the same size.
    void copy(const BlockBand& other) noexcept { columns_ = other.columns_; }
    /// Adds to block (i, j), i - j = 0, 1 or 2, and to its mirror image.
    void add(std::size_t i, std::size_t j, const Mat3& block) noexcept {
        const Place at = place_of(i, j);
        Column& c = columns_[at.column];
        const int lane = at.lane;
        if (i == j) {
            std::size_t n = 0;
            for (int b = 0; b < 3; ++b)
                for (int a = b; a < 3; ++a, ++n) c.diagonal[n][lane] += block[b][a];
            return;
        }
        Block& to = i - j == 1 ? c.next : c.second;
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                to[static_cast<std::size_t>(3 * b + a)][lane] += lane == 0 ? block[b][a] : block[a][b];
    }
    void add(std::size_t i, std::size_t j, double diagonal) noexcept {
        const Place at = place_of(i, j);
        Column& c = columns_[at.column];
        if (i == j) {
            for (const std::size_t n : {0u, 3u, 5u}) c.diagonal[n][at.lane] += diagonal;
            return;
        }
        Block& to = i - j == 1 ? c.next : c.second;
        for (const std::size_t n : {0u, 4u, 8u}) to[n][at.lane] += diagonal;
    }
    /// Replaces the equations of point i by x = right side; the right side must be 0.
    void fix(std::size_t i) noexcept {
        const std::size_t first = i > 2 ? i - 2 : 0, last = i + 2 < size_ ? i + 2 : size_ - 1;
        for (std::size_t n = first; n <= last; ++n) {
            const Place at = n < i ? place_of(i, n) : place_of(n, i);
            Column& c = columns_[at.column];
            const std::size_t apart = n < i ? i - n : n - i;
            if (apart == 0)
                for (std::size_t k = 0; k < 6; ++k) c.diagonal[k][at.lane] = k == 0 || k == 3 || k == 5 ? 1.0 : 0.0;
            else
                for (Pair& v : apart == 1 ? c.next : c.second) v[at.lane] = 0.0;
        }
    }
    /// Solves for `x`, which holds the right side; the matrix is overwritten by its factors. Returns false if it is not
    /// positive definite.
    bool solve(std::vector<Vec3>& x) noexcept;

private:
    using Pair = double __attribute__((vector_size(16)));  // the same element of both halves
    using Block = std::array<Pair, 9>;  // by columns
    struct Column {
        std::array<Pair, 6> diagonal{};  // 00, 10, 20, 11, 21, 22; then factors and reciprocal pivots
        Block next{}, second{};  // rows of the next point towards the middle, and of the one after it
    };
    using Right = std::array<Pair, 3>;
    struct Place {
        std::size_t column;
        int lane;
    };

    // Points 0, 1, … up to the middle are the first lane, the last ones backwards are the second one. Both lanes end
    // with the points middle_ and middle_ + 1 (the second lane in reverse order), whose elements are in the first.
    Place place_of(std::size_t i, std::size_t j) const noexcept {
        if (i <= middle_ + 1) return {j, 0};
        return {size_ - 1 - i + size_ % 2, 1};
    }
    bool solve_middle(std::vector<Vec3>& x) noexcept;

    std::size_t size_, middle_;
    std::vector<Column> columns_;
    std::vector<Right> right_;
};

}  // namespace tactus::rope
