// SPDX-License-Identifier: Apache-2.0
// Analytic bodies with exact distances and evenly distributed surface points. m, about the z axis or the origin.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"

#include <glm/vec2.hpp>

#include <vector>

namespace tactus::contact {

/// A cubic grid centred at the origin, m; its values are not set.
volume::Grid centred_layout(int samples_per_side, double spacing);
/// A grid with samples `spacing` apart that contains the box from `low` to `high` and `margin` around it, m.
volume::Grid layout_around(const Vec3& low, const Vec3& high, double spacing, double margin);

/// `count` points on a sphere about the origin, on a Fibonacci spiral (golden angle).
std::vector<SurfacePoint> spread_over_ball(int count, double radius);

struct Ball {
    double radius = 10e-3;

    double distance(const Vec3& p) const;
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const { return Vec3(-radius); }
    Vec3 high() const { return Vec3(radius); }
};

/// Centred at the origin.
struct Box {
    Vec3 size{20e-3};

    double distance(const Vec3& p) const;
    /// Includes edges and corners, with averaged normals.
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const { return -0.5 * size; }
    Vec3 high() const { return 0.5 * size; }
};

/// Solid of revolution: a polygon in the half-plane (distance from the axis, height) rotated about the z axis.
/// Counter-clockwise with the height upwards, so that the solid lies to the left of its edges.
struct Revolved {
    std::vector<glm::dvec2> profile;

    double distance(const Vec3& p) const;
    std::vector<SurfacePoint> points(double spacing) const;
    Vec3 low() const;
    Vec3 high() const;
};

/// A cylinder with its base on z = 0; the lower rim is bevelled by `bevel` at 45°.
Revolved make_cylinder(double diameter, double height, double bevel = 0.0);
/// A round block below z = 0 with a hole along its axis; `bevel` widens the hole's mouth at 45°.
Revolved make_bushing(double bore, double diameter, double height, double bevel = 0.0);

/// Samples the distance field of a shape on a grid with a margin of `margin` m.
template <class Shape>
Voxmap voxmap_of(const Shape& shape, double spacing, double margin) {
    return sample_voxmap(layout_around(shape.low(), shape.high(), spacing, margin),
                         [&](const Vec3& p) { return shape.distance(p); });
}

}  // namespace tactus::contact
