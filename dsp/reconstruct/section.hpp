// SPDX-License-Identifier: Apache-2.0
// Where a plane cuts a bone's surface.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::reconstruct {

/// Points x with normal · (x - origin) = 0.
struct Plane {
    Vec3 origin{0.0};
    Vec3 normal{0.0, 0.0, 1.0};  ///< unit length
};

struct Section {
    std::vector<Vec3> points;  ///< in which the plane meets edges of the surface
    std::vector<std::array<int, 2>> edge;  ///< of each point: its two vertices, the lesser first
    std::vector<std::size_t> outline;  ///< of each point: the same number for the points of one outline
    std::vector<std::array<std::size_t, 2>> pieces;  ///< of the outlines, one per triangle, as indices into points
    std::vector<std::size_t> triangle;  ///< of each piece
    Vec3 centre{0.0};  ///< of the outlines, each piece by its length
    double away = 0.0;  ///< m: how far `near` lies outside the outlines; 0 inside them
};

/// The outlines in which the plane meets the surface. With `near`, only those that enclose it, or where none does the
/// one that comes nearest, and what lies inside of these: a plane through one limb of a bone must not cut the other one,
/// and cuts a hollow limb with its marrow cavity. Empty when the plane misses the surface.
Section section_of(const geometry::TriangleSurface& surface, const Plane& plane, const Vec3* near = nullptr);

/// The connected parts of a surface whose vertices lie, on average, at most `farthest` from a line: one bone of a leg,
/// with its marrow cavity. Throws Error when there is none.
geometry::TriangleSurface parts_near_line(const geometry::TriangleSurface& surface, const Vec3& point,
                                          const Vec3& direction, double farthest);

/// Area in which two sections of one plane overlap, m². Even-odd rule, by lines `step` apart: a section with a marrow
/// cavity has a hole. Both must be closed; their points are given in the same frame.
double overlap_area(const Section& a, const Section& b, const Plane& plane, double step = 0.1e-3);

}  // namespace tactus::reconstruct
