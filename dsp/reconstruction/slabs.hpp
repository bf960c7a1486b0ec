// SPDX-License-Identifier: Apache-2.0
// An index of a long bone's surface by slabs along its line: a section visits only the triangles near its plane.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/section.hpp"

#include <cstddef>
#include <vector>

namespace tactus::reconstruction {

/// Refers to a surface that must outlive it. The constructor sorts all triangles once; a section then takes time
/// proportional to its own size. Not thread-safe.
class Slabs {
public:
    /// `axis` has unit length.
    Slabs(const geometry::TriangleSurface& surface, const Vec3& point, const Vec3& axis);

    /// Equals section_of(surface, plane, near) bit by bit, except for the indices of vertices and triangles (edge,
    /// triangle).
    Section section(const Plane& plane, const Vec3* near) const;

private:
    std::size_t slab_of(double along) const;

    const geometry::TriangleSurface& surface_;
    Vec3 point_, axis_;
    double low_ = 0.0, radius_ = 0.0, longest_ = 0.0;  // m: lowest position, distance from the line, longest triangle
    std::vector<std::size_t> begin_;  // of each slab, in order_
    std::vector<int> order_;  // triangles by the slab of their lowest position
    mutable std::vector<int> number_, chosen_;  // of vertices in a part
    mutable geometry::TriangleSurface part_;
};

}  // namespace tactus::reconstruction
