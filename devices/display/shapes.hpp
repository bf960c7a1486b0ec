// SPDX-License-Identifier: Apache-2.0
// Simple shapes for images. All functions append to a surface patch. Lengths in m; colours sRGB, 0 to 1.
#pragma once

#include "dsp/contact/blade.hpp"
#include "dsp/core/types.hpp"
#include "dsp/geometry/brick_surface.hpp"

namespace tactus::display {

/// A flat-shaded triangle with its own vertices.
void add_triangle(geometry::SurfacePatch& patch, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& colour,
                  double opacity = 1.0);
void add_ball(geometry::SurfacePatch& patch, const Vec3& centre, double radius, const Vec3& colour);
/// A box between two opposite corners, in a frame.
void add_box(geometry::SurfacePatch& patch, const Vec3& low, const Vec3& high, const Vec3& colour,
             const Pose& frame = {});
/// An arrow with shaft and head, the tip at `to`; nothing when both ends coincide.
void add_arrow(geometry::SurfacePatch& patch, const Vec3& from, const Vec3& to, double radius, const Vec3& colour);
/// Coordinate axes: x red, y green, z blue.
void add_axes(geometry::SurfacePatch& patch, const Pose& pose, double length);
/// A saw blade with teeth, as defined by BladeShape.
void add_blade(geometry::SurfacePatch& patch, const contact::BladeShape& shape, const Vec3& colour);
/// A two-sided square in a plane.
void add_square(geometry::SurfacePatch& patch, const Vec3& centre, const Vec3& normal, double side, const Vec3& colour,
                double opacity);

}  // namespace tactus::display
