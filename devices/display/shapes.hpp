// SPDX-License-Identifier: Apache-2.0
// Simple bodies for pictures. All functions add to a patch. m; colours sRGB 0 to 1.
#pragma once

#include "dsp/contact/blade.hpp"
#include "dsp/core/types.hpp"
#include "dsp/view/brick_surface.hpp"

namespace tactus {

/// Flat: its three vertices are its own.
void add_triangle(SurfacePatch& patch, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& colour,
                  double opacity = 1.0);
void add_ball(SurfacePatch& patch, const Vec3& centre, double radius, const Vec3& colour);
/// Between two opposite corners, in a frame.
void add_box(SurfacePatch& patch, const Vec3& low, const Vec3& high, const Vec3& colour, const Pose& frame = {});
/// Shaft and head, the tip at `to`; nothing when both ends are one.
void add_arrow(SurfacePatch& patch, const Vec3& from, const Vec3& to, double radius, const Vec3& colour);
/// Three thin arrows: x red, y green, z blue.
void add_axes(SurfacePatch& patch, const Pose& pose, double length);
/// A saw blade with teeth, as BladeShape describes it.
void add_blade(SurfacePatch& patch, const BladeShape& shape, const Vec3& colour);
/// A square of a plane, seen from both sides.
void add_square(SurfacePatch& patch, const Vec3& centre, const Vec3& normal, double side, const Vec3& colour,
                double opacity);

}  // namespace tactus
