// SPDX-License-Identifier: Apache-2.0
// The surface that a ball-shaped proxy touches: a distance field or triangles, with an optional wave texture.
//
// Triangles are exact: the proxy's centre stays outside of the points nearer to them than its radius (Ruspini, Kolarov
// and Khatib 1997), and a moving ball stops where it first touches one. For a field, the surface is the level set at
// the ball's radius; it is followed in steps of at most half a voxel, each projected back to the level.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"
#include "dsp/coupling/proxy_planes.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <algorithm>

namespace tactus::coupling {

/// Maximum radius of a ball that stands for a point, m.
inline constexpr double point_radius = 1e-6;

struct ProxyShape {
    double radius = 0.0;  ///< m, of the ball
    double texture_height =
        0.0;  ///< m, amplitude of the wave texture, from its mean, which is the surface, to the crest
    double texture_length = 2e-3;  ///< m, wavelength along each axis of the body
    double step = 0.25e-3;  ///< m: maximum length of a step along a field; never more than half a voxel

    /// Radius of the ball that keeps off triangles, m: small enough to reach the troughs of their texture.
    double core() const noexcept { return std::max(radius - texture_height, std::min(radius, point_radius)); }
    /// By how much the texture of triangles lies above them, m: a point cannot be in a trough below a triangle.
    double raised() const noexcept { return texture_height - (radius - core()); }
};

/// One surface: its triangles if there are any, otherwise its distance field.
struct ProxySurface {
    using Budget = geometry::TriangleTree::Budget;

    const contact::Voxmap* map = nullptr;
    const geometry::TriangleTree* triangles = nullptr;
    Pose pose;

    /// A field, or a surface with texture, seen from a position: one smooth surface.
    struct Level {
        bool seen = false;  ///< a direction out of the body was found
        ProxyPlane plane;
        double room = 0.0;  ///< m: a move of this length in any direction is free
    };

    /// True for triangles without texture, which do not need `level`.
    bool is_exact(const ProxyShape& shape) const noexcept { return triangles && !(shape.texture_height > 0.0); }
    /// These three spend triangles of a budget. When it is spent, nothing is found and no move is free.
    Level level(const Vec3& at, const ProxyShape& shape, Budget& budget) const noexcept;
    /// Maximum move beyond what is free, m.
    double stride(const ProxyShape& shape) const noexcept;
    /// Planes of all triangles that a ball at `at` touches.
    void touched(const Vec3& at, const ProxyShape& shape, ProxyPlanes& into, Budget& budget) const noexcept;
    /// Distance that the core of a ball can move along the unit vector `direction` before it touches a triangle, m; at most
    /// `length`.
    double free_distance(const Vec3& at, const Vec3& direction, double length, const ProxyShape& shape,
                         Budget& budget) const noexcept;
};

inline constexpr double proxy_hover = 1e-7;  ///< m: distance at which a proxy is held off a surface
inline constexpr double proxy_touch = 3e-7;  ///< m: nearer surfaces count as touched

}  // namespace tactus::coupling
