// SPDX-License-Identifier: Apache-2.0
// Triangles in an AABB tree: nearest point, triangles within a distance, first hit of a moving ball.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Read-only after construction; no query allocates. m, frame of the surface.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleSurface& surface);

    /// Limits the number of triangles that queries may test. A query that would exceed it stops: its result is then
    /// invalid, and `is_spent` is true.
    struct Budget {
        std::int64_t triangles = std::numeric_limits<std::int64_t>::max();

        bool is_spent() const noexcept { return triangles < 0; }
        /// Consumes `count` triangles; returns false if fewer remain.
        bool spend(std::int64_t count) noexcept {
            triangles -= count;
            return triangles >= 0;
        }
    };

    struct Near {
        Vec3 point{0.0};  ///< the closest point on the triangles
        double distance = std::numeric_limits<double>::infinity();
        /// Unit, interpolated between the corners' normals; zero next to sharp edges.
        Vec3 normal{0.0};
    };
    /// Returns the closest point of all triangles nearer than `within`; infinite distance if there is none.
    Near nearest(const Vec3& p, double within = std::numeric_limits<double>::infinity()) const noexcept {
        Budget all;
        return nearest(p, within, all);
    }
    Near nearest(const Vec3& p, double within, Budget& budget) const noexcept;
    /// Closest points of triangles nearer than `within`, one per triangle, in the order of the tree, until `found` is
    /// full.
    std::size_t all_near(const Vec3& p, double within, std::span<Near> found, Budget& budget) const noexcept;
    /// Returns the fraction of the motion from `from` to `from` + `translation` at which a ball first touches a
    /// triangle that it does not move away from, 0 to 1; 1 if it touches none.
    double sweep(const Vec3& from, const Vec3& translation, double radius) const noexcept {
        Budget all;
        return sweep(from, translation, radius, all);
    }
    /// Returns 0 if the budget is exhausted.
    double sweep(const Vec3& from, const Vec3& translation, double radius, Budget& budget) const noexcept;

    std::size_t size() const noexcept { return corners_.size() / 3; }

private:
    struct Node {
        Vec3 low, high;
        std::uint32_t first = 0, count = 0;  // triangles of a leaf; of an inner node, `first` is its second child
    };
    Near near_on(std::size_t triangle, const Vec3& p) const noexcept;
    std::uint32_t build(std::span<std::uint32_t> order, const std::vector<Vec3>& corners, std::uint32_t first);

    std::vector<Node> nodes_;  // an inner node's first child follows it
    std::vector<Vec3> corners_, normals_;  // three per triangle, in the order of the leaves
};

}  // namespace tactus::geometry
