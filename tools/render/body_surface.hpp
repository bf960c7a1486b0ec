// SPDX-License-Identifier: Apache-2.0
// The drawn surface of a scene's body: the zero surface of its distance field, coloured at its painted points.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/display/camera.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "engine/observe/seen_values.hpp"

namespace tactus::render {

struct BodySurface {
    geometry::SurfacePatch patch;  ///< in the frame of the body, m
    display::Bounds bounds;
    bool has_paint = false;  ///< some points are labelled as fracture
};

/// A surface net: two triangles for each crossing grid edge, with vertices moved onto the surface. `field`: the
/// distance field of the body.
BodySurface make_body_surface(const observe::SeenBody& body, const contact::Voxmap& field, const Vec3& colour,
                              const Vec3& paint_colour);

}  // namespace tactus::render
