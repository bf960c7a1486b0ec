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
/// middle of the range.
class PointTree {
public:
    explicit PointTree(std::span<const Vec3> points)
        : points_(points.begin(), points.end()), order_(points.size()), axis_(points.size(), 0) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        arrange(0, order_.size());
    }

    bool empty() const noexcept { return points_.empty(); }

    /// Index of the nearest point; 0 for an empty tree. Does not allocate.
    std::size_t nearest(const Vec3& place) const noexcept {
        Search search{place, std::numeric_limits<double>::infinity(), 0};
        look(search, 0, order_.size());
        return search.best;
    }

private:
    struct Search {
        Vec3 place;
        double least;
        std::size_t best;
    };

    void arrange(std::size_t first, std::size_t last) {
        if (last - first < 2) return;
        Vec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
        for (std::size_t n = first; n < last; ++n) {
            low = glm::min(low, points_[order_[n]]);
            high = glm::max(high, points_[order_[n]]);
        }
        const Vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::size_t middle = (first + last) / 2;
        const auto at = [this](std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
        std::nth_element(at(first), at(middle), at(last),
                         [&](std::size_t a, std::size_t b) { return points_[a][axis] < points_[b][axis]; });
        axis_[middle] = static_cast<std::uint8_t>(axis);
        arrange(first, middle);
        arrange(middle + 1, last);
    }

    void look(Search& search, std::size_t first, std::size_t last) const noexcept {
        if (first >= last) return;
        const std::size_t middle = (first + last) / 2;
        const Vec3 difference = search.place - points_[order_[middle]];
        const double square = glm::dot(difference, difference), side = difference[axis_[middle]];
        if (square < search.least) search.least = square, search.best = order_[middle];
        if (side < 0.0) look(search, first, middle);
        else look(search, middle + 1, last);
        if (side * side >= search.least) return;
        if (side < 0.0) look(search, middle + 1, last);
        else look(search, first, middle);
    }

    std::vector<Vec3> points_;
    std::vector<std::size_t> order_;
    std::vector<std::uint8_t> axis_;
};

}  // namespace tactus::geometry
