// SPDX-License-Identifier: Apache-2.0
// Exact nearest-neighbour search in a k-d tree.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace tactus::geometry {

/// An implicit k-d tree: the median of a range of points, along the longest axis of its bounding box, is stored in the
/// middle of the range. Points are stored in the order of the tree, so that a search reads memory in sequence. Cells
/// are pruned by their distance from the query along all axes (Arya and Mount 1993).
class PointTree {
public:
    PointTree() = default;
    explicit PointTree(std::span<const Vec3> points) { assign(points); }

    /// Reserves memory for this many points.
    void reserve(std::size_t points) {
        points_.reserve(points);
        index_.reserve(points);
        rank_.reserve(points);
        axis_.reserve(points);
    }
    /// Replaces the points; does not allocate within the reserved memory.
    void assign(std::span<const Vec3> points) {
        index_.resize(points.size());
        rank_.resize(points.size());
        axis_.assign(points.size(), 0);
        std::iota(index_.begin(), index_.end(), std::uint32_t{0});
        arrange(points, 0, points.size());
        points_.clear();
        for (std::size_t n = 0; n < points.size(); ++n) {
            points_.push_back(points[index_[n]]);
            rank_[index_[n]] = static_cast<std::uint32_t>(n);
        }
    }

    bool empty() const noexcept { return points_.empty(); }

    /// Returns whether a point is nearer to `place` than `distance`, m. Does not allocate.
    bool has_nearer(const Vec3& place, double distance) const noexcept {
        // Only points below this distance count; the search ends at the first one.
        Search search{place, distance * distance, 0, false};
        if (!points_.empty()) look_for_any(search, 0, points_.size(), Vec3(0.0), 0.0);
        return search.is_found;
    }

    /// Index of the nearest point, the lowest of several; 0 for an empty tree. Does not allocate.
    std::size_t nearest(const Vec3& place) const noexcept {
        return found({place, std::numeric_limits<double>::infinity(), std::numeric_limits<std::uint32_t>::max()});
    }

    /// The same, faster when the point `guess` is near `place`. The result does not depend on it.
    std::size_t nearest(const Vec3& place, std::size_t guess) const noexcept {
        if (!(guess < points_.size())) return nearest(place);
        const Vec3 difference = place - points_[rank_[guess]];
        return found({place, glm::dot(difference, difference), static_cast<std::uint32_t>(guess)});
    }

private:
    static constexpr std::size_t leaf = 8;  // points of a cell that is not divided

    struct Search {
        Vec3 place;
        double least;
        std::uint32_t best;
        bool is_found = false;
    };

    void look_for_any(Search& search, std::size_t first, std::size_t last, const Vec3& outside,
                      double away2) const noexcept {
        const auto is_near = [&](std::size_t n) {
            const Vec3 difference = search.place - points_[n];
            return search.is_found = glm::dot(difference, difference) < search.least;
        };
        if (last - first <= leaf) {
            for (std::size_t n = first; n < last; ++n)
                if (is_near(n)) return;
            return;
        }
        const std::size_t middle = (first + last) / 2;
        const int axis = axis_[middle];
        const double side = search.place[axis] - points_[middle][axis];
        const auto half = [&](bool lower, const Vec3& from, double from2) {
            if (lower) look_for_any(search, first, middle, from, from2);
            else look_for_any(search, middle + 1, last, from, from2);
        };
        half(side < 0.0, outside, away2);
        if (search.is_found || is_near(middle)) return;
        const double other2 = away2 + side * side - outside[axis] * outside[axis];
        if (other2 * (1.0 - 1e-12) > search.least) return;
        Vec3 beyond = outside;
        beyond[axis] = side;
        half(!(side < 0.0), beyond, other2);
    }

    std::size_t found(Search search) const noexcept {
        if (points_.empty()) return 0;
        look(search, 0, points_.size(), Vec3(0.0), 0.0);
        return search.best < points_.size() ? search.best : 0;
    }

    void arrange(std::span<const Vec3> points, std::size_t first, std::size_t last) {
        if (last - first <= leaf) return;
        Vec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
        for (std::size_t n = first; n < last; ++n) {
            low = glm::min(low, points[index_[n]]);
            high = glm::max(high, points[index_[n]]);
        }
        const Vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::size_t middle = (first + last) / 2;
        const auto at = [this](std::size_t n) { return index_.begin() + static_cast<std::ptrdiff_t>(n); };
        std::nth_element(at(first), at(middle), at(last),
                         [&](std::uint32_t a, std::uint32_t b) { return points[a][axis] < points[b][axis]; });
        axis_[middle] = static_cast<std::uint8_t>(axis);
        arrange(points, first, middle);
        arrange(points, middle + 1, last);
    }

    void test(Search& search, std::size_t n) const noexcept {
        const Vec3 difference = search.place - points_[n];
        const double square = glm::dot(difference, difference);
        if (square < search.least || (square == search.least && index_[n] < search.best))
            search.least = square, search.best = index_[n];
    }

    /// `outside`: distances from the query to the cell along the axes; `away2`: the sum of their squares.
    void look(Search& search, std::size_t first, std::size_t last, const Vec3& outside, double away2) const noexcept {
        if (last - first <= leaf) {
            for (std::size_t n = first; n < last; ++n) test(search, n);
            return;
        }
        const std::size_t middle = (first + last) / 2;
        const int axis = axis_[middle];
        const double side = search.place[axis] - points_[middle][axis];
        if (side < 0.0) look(search, first, middle, outside, away2);
        else look(search, middle + 1, last, outside, away2);
        test(search, middle);
        const double other2 = away2 + side * side - outside[axis] * outside[axis];
        // Rounding must not exclude a point at the same distance.
        if (other2 * (1.0 - 1e-12) > search.least) return;
        Vec3 beyond = outside;
        beyond[axis] = side;
        if (side < 0.0) look(search, middle + 1, last, beyond, other2);
        else look(search, first, middle, beyond, other2);
    }

    std::vector<Vec3> points_;
    std::vector<std::uint32_t> index_, rank_;  // original index of a stored point, and the reverse
    std::vector<std::uint8_t> axis_;
};

}  // namespace tactus::geometry
