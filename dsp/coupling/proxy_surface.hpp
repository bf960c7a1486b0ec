// SPDX-License-Identifier: Apache-2.0
// What a ball-shaped proxy touches: a distance field or triangles, with waves on it if wanted.
//
// Triangles are exact: the proxy's centre stays outside of all that is nearer to them than its radius (Ruspini, Kolarov
// and Khatib 1997), and a moving ball is stopped where it first touches one. A field has the level set of its radius for
// a surface; it is followed in steps of half a voxel at most, each brought back to the level.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"
#include "dsp/coupling/proxy_planes.hpp"
#include "dsp/geometry/triangle_tree.hpp"

namespace tactus::coupling {

struct ProxyShape {
    double radius = 0.0;  ///< m, of the ball
    double texture_height = 0.0;  ///< m, of waves that stand on the surface, from their mean to the top
    double texture_length = 2e-3;  ///< m, of a wave, along each axis of the body
    double step = 0.25e-3;  ///< m: farthest move along a field at a time; half a voxel at most in any case
};

/// One surface: a distance field, or triangles when there are any.
struct ProxySurface {
    const contact::Voxmap* map = nullptr;
    const geometry::TriangleTree* triangles = nullptr;
    Pose pose;

    /// How a field, or a surface with waves, looks from a place: one surface, round everywhere.
    struct Level {
        bool seen = false;  ///< there is a direction out of it
        ProxyPlane plane;
        double room = 0.0;  ///< m: a move of this length is surely free, whichever way it goes
    };

    /// True for triangles without waves: nothing of `level` is needed then.
    bool is_exact(const ProxyShape& shape) const noexcept { return triangles && !(shape.texture_height > 0.0); }
    Level level(const Vec3& at, const ProxyShape& shape) const noexcept;
    /// Farthest sensible move beyond what is free, m.
    double stride(const ProxyShape& shape) const noexcept;
    /// Planes of all triangles that a ball at `at` touches.
    void touched(const Vec3& at, const ProxyShape& shape, ProxyPlanes& into) const noexcept;
    /// How far a ball may go along the unit vector `direction` before it touches a triangle, m; at most `length`.
    double free_distance(const Vec3& at, const Vec3& direction, double length, const ProxyShape& shape) const noexcept;
};

inline constexpr double proxy_hover = 1e-7;  ///< m: how far off a surface a proxy is held
inline constexpr double proxy_touch = 3e-7;  ///< m: what is nearer counts as touched

}  // namespace tactus::coupling
