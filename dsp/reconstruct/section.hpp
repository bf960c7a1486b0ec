// SPDX-License-Identifier: Apache-2.0
// Where a plane cuts a bone's surface.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <vector>

namespace tactus::reconstruct {

/// Points x with normal · (x - origin) = 0.
struct Plane {
    Vec3 origin{0.0};
    Vec3 normal{0.0, 0.0, 1.0};  ///< unit length
};

/// The points in which the plane meets the edges of the surface, in no order. With `near`, only those of the connected
/// outline that comes nearest to it: a plane through one limb of a bone must not cut the other one.
std::vector<Vec3> section_points(const geometry::TriangleSurface& surface, const Plane& plane,
                                 const Vec3* near = nullptr);

}  // namespace tactus::reconstruct
