// SPDX-License-Identifier: Apache-2.0
// The vertices of a triangle mesh as surface points.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <vector>

namespace tactus::fit {

/// One point per vertex, with the mean normal of its triangles, weighted by area, and a third of their areas (m²). A
/// registration needs no denser points, because it measures distances to the plane of a point. The mesh need not be
/// closed. Vertices without a normal, such as those of no triangle, are left out.
std::vector<contact::SurfacePoint> vertex_points(const geometry::TriangleSurface& mesh);

}  // namespace tactus::fit
