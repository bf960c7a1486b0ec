// SPDX-License-Identifier: Apache-2.0
// Fixed-radius neighbour search.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace tactus::contact {

/// Surface points sorted into cubes; a binary search finds those within one cube side of a point.
class Neighbours {
public:
    /// `points` must outlive this object and must not move; `side` in m.
    Neighbours(std::span<const SurfacePoint> points, double side) : points_(points), side_(side) {
        Vec3 low(std::numeric_limits<double>::infinity());
        for (const SurfacePoint& p : points) low = glm::min(low, p.position);
        // A margin of one cube keeps all indices positive.
        origin_ = low - Vec3(2.0 * side);
        for (std::size_t i = 0; i < points.size(); ++i) sorted_.push_back({key_of(cell(points[i].position)), i});
        std::ranges::stable_sort(sorted_, {}, &Entry::key);
    }

    /// Calls visit(index) for all points within `side` of point i, including i, in a fixed order.
    template <class Visit>
    void around(std::size_t i, const Visit& visit) const {
        const glm::i64vec3 c = cell(points_[i].position);
        for (std::int64_t dz = -1; dz <= 1; ++dz)
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                // Cubes along x have adjacent keys.
                const std::uint64_t first = key_of({c.x - 1, c.y + dy, c.z + dz}), last = first + 2;
                auto at = std::ranges::lower_bound(sorted_, first, {}, &Entry::key);
                for (; at != sorted_.end() && at->key <= last; ++at) {
                    const Vec3 difference = points_[at->index].position - points_[i].position;
                    if (glm::dot(difference, difference) <= side_ * side_) visit(at->index);
                }
            }
    }

private:
    struct Entry {
        std::uint64_t key;
        std::size_t index;
    };

    glm::i64vec3 cell(const Vec3& p) const { return glm::i64vec3(glm::floor((p - origin_) / side_)); }
    static std::uint64_t key_of(const glm::i64vec3& c) {
        return static_cast<std::uint64_t>(c.x) | static_cast<std::uint64_t>(c.y) << 21 |
               static_cast<std::uint64_t>(c.z) << 42;
    }

    std::span<const SurfacePoint> points_;
    double side_;
    Vec3 origin_{0.0};
    std::vector<Entry> sorted_;
};

/// Connected components of the points that satisfy a condition; points within `side` of each other are neighbours. One
/// list of indices per component, ordered by first point.
template <class Condition>
std::vector<std::vector<std::size_t>> patches_of(std::span<const SurfacePoint> points, double side,
                                                 const Condition& belongs) {
    const Neighbours neighbours(points, side);
    std::vector<bool> seen(points.size(), false);
    std::vector<std::vector<std::size_t>> patches;
    for (std::size_t first = 0; first < points.size(); ++first) {
        if (seen[first] || !belongs(first)) continue;
        std::vector<std::size_t> patch{first};
        seen[first] = true;
        for (std::size_t n = 0; n < patch.size(); ++n)
            neighbours.around(patch[n], [&](std::size_t j) {
                if (seen[j] || !belongs(j)) return;
                seen[j] = true;
                patch.push_back(j);
            });
        patches.push_back(std::move(patch));
    }
    return patches;
}

}  // namespace tactus::contact
