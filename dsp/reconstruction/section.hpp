// SPDX-License-Identifier: Apache-2.0
// Sections of a bone's surface with a plane.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::reconstruction {

/// The points x with normal · (x - origin) = 0.
struct Plane {
    Vec3 origin{0.0};
    Vec3 normal{0.0, 0.0, 1.0};  ///< unit length
};

struct Section {
    std::vector<Vec3> points;  ///< where the plane meets edges of the surface
    std::vector<std::array<int, 2>> edge;  ///< of each point: the two vertices of its edge, the lower index first
    std::vector<std::size_t> outline;  ///< of each point: the same number for the points of one outline
    std::vector<std::array<std::size_t, 2>> pieces;  ///< segments of outlines, one per triangle: indices into points
    std::vector<std::size_t> triangle;  ///< of each segment
    Vec3 centre{0.0};  ///< of the outlines, each segment weighted by its length
    double away = 0.0;  ///< m: distance of `near` outside the outlines; 0 inside them
};

/// Returns the outlines of the section. With `near`, only the outlines that enclose it (or, if none does, the nearest
/// one) and those inside of them: a plane through one limb of a bone must not cut the other one, and must cut a hollow
/// limb with its marrow cavity. Empty if the plane misses the surface.
Section section_of(const geometry::TriangleSurface& surface, const Plane& plane, const Vec3* near = nullptr);

/// Returns the connected parts of a surface whose vertices have a mean distance of at most `farthest` from a line: one
/// bone of a leg with its marrow cavity. Throws Error if there is none.
geometry::TriangleSurface parts_near_line(const geometry::TriangleSurface& surface, const Vec3& point,
                                          const Vec3& direction, double farthest);

/// Returns the area in which two sections of one plane overlap, m². Uses the even-odd rule along lines `step` apart, so
/// that a marrow cavity is a hole. Both must be closed and have points in the same frame.
double overlap_area(const Section& a, const Section& b, const Plane& plane, double step = 0.1e-3);

}  // namespace tactus::reconstruction
