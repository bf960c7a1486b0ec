// SPDX-License-Identifier: Apache-2.0
// Bodies by formula: exact distance and evenly spread surface points. m, about the z axis or the origin.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"

#include <glm/vec2.hpp>

#include <vector>

namespace tactus::contact {

/// A cube of samples about the origin, m; values are left to whoever fills them.
volume::Grid centred_layout(int samples_per_side, double spacing);
/// A box of samples `spacing` apart that holds all from `low` to `high` and `margin` around it, m.
volume::Grid layout_around(const Vec3& low, const Vec3& high, double spacing, double margin);

/// `count` points on a ball about the origin, evenly spread along a spiral of the golden angle.
std::vector<SurfacePoint> spread_over_ball(int count, double radius);

struct Ball {
    double radius = 10e-3;

    double distance(const Vec3& p) const;
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const { return Vec3(-radius); }
    Vec3 high() const { return Vec3(radius); }
};

/// About the origin.
struct Box {
    Vec3 size{20e-3};

    double distance(const Vec3& p) const;
    /// Also on edges and corners, where normals are means.
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const { return -0.5 * size; }
    Vec3 high() const { return 0.5 * size; }
};

/// A polygon in the half-plane (distance from the axis, height) turned about the z axis; counter-clockwise, with the
/// height upwards and the solid to its left.
struct Revolved {
    std::vector<glm::dvec2> profile;

    double distance(const Vec3& p) const;
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const;
    Vec3 high() const;
};

/// Upright on z = 0, the lower rim bevelled by `bevel` at 45°.
Revolved make_cylinder(double diameter, double height, double bevel = 0.0);
/// A round block below z = 0 with a hole through it along its axis, the mouth widened by `bevel` at 45°.
Revolved make_bushing(double bore, double diameter, double height, double bevel = 0.0);

/// The distance field of a shape and `margin` m around it.
template <class Shape>
Voxmap voxmap_of(const Shape& shape, double spacing, double margin) {
    return sample_voxmap(layout_around(shape.low(), shape.high(), spacing, margin),
                         [&](const Vec3& p) { return shape.distance(p); });
}

}  // namespace tactus::contact
