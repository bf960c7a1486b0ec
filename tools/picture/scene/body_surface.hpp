// SPDX-License-Identifier: Apache-2.0
// What a body of a scene looks like: the zero surface of its distance field, painted where its points are.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/display/camera.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "engine/observe/seen_values.hpp"

namespace tactus::picture {

struct BodySurface {
    geometry::SurfacePatch patch;  ///< in the frame of the body, m
    display::Bounds bounds;
    bool has_paint = false;  ///< some of its points are labelled as fracture
};

/// Two triangles for each crossing edge of the grid, its vertices drawn onto the surface. `field` is the body's own.
BodySurface make_body_surface(const observe::SeenBody& body, const contact::Voxmap& field, const Vec3& colour,
                              const Vec3& paint_colour);

}  // namespace tactus::picture
