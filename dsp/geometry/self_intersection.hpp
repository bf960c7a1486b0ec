// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles of a surface that intersect.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Whether two triangles of one surface intersect beyond the vertices that they share: no axis separates them (Gottschalk,
/// Lin, Manocha 1996), or they have an edge in common and lie on each other. Triangles that touch or overlap by less than
/// a millionth of their longest edge do not intersect, nor do those without area.
bool intersect(const TriangleSurface& surface, std::size_t a, std::size_t b) noexcept;

/// Boxes of the triangles of a surface in a tree.
class TriangleBoxes {
public:
    /// Vertices may move by `margin` afterwards: m. The surface must outlive this object.
    explicit TriangleBoxes(const TriangleSurface& surface, double margin = 0.0);

    /// Adds the pairs of triangle `t` with those of greater number, or with all others, that intersect it now.
    void intersections_of(std::size_t t, bool with_all, std::vector<std::array<int, 2>>& found) const;

private:
    struct Node {
        Vec3 low, high;
        std::uint32_t first = 0, count = 0;  // triangles of a leaf; else `first` is the second child
    };
    void build(std::span<std::uint32_t> part, std::uint32_t first);

    const TriangleSurface& surface_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Vec3> low_, high_;  // of each triangle
};

/// Numbers of all triangles that intersect another one, in pairs, the lesser first, ascending; at most `most` pairs. By a
/// tree of boxes.
std::vector<std::array<int, 2>> self_intersections(const TriangleSurface& surface, std::size_t most = 100000,
                                                   const RunJobs& run = run_in_turn);

}  // namespace tactus::geometry
