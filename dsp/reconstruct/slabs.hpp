// SPDX-License-Identifier: Apache-2.0
// A long bone's surface in slabs along its line: a section looks at the triangles near its plane only.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruct/section.hpp"

#include <cstddef>
#include <vector>

namespace tactus::reconstruct {

/// Refers to a surface that must outlive it. Construction sorts all triangles once; sections then take time by their
/// own size. Not for several threads at once.
class Slabs {
public:
    /// `axis` has unit length.
    Slabs(const geometry::TriangleSurface& surface, const Vec3& point, const Vec3& axis);

    /// section_of(surface, plane, near) to the bit, apart from its numbers of vertices and triangles (edge, triangle).
    Section section(const Plane& plane, const Vec3* near) const;

private:
    std::size_t slab_of(double along) const;

    const geometry::TriangleSurface& surface_;
    Vec3 point_, axis_;
    double low_ = 0.0, radius_ = 0.0, longest_ = 0.0;  // m: least place along, farthest from the line, longest triangle
    std::vector<std::size_t> begin_;  // of each slab in order_
    std::vector<int> order_;  // triangles by the slab of their least place
    mutable std::vector<int> number_, chosen_;  // of vertices in a part
    mutable geometry::TriangleSurface part_;
};

}  // namespace tactus::reconstruct
