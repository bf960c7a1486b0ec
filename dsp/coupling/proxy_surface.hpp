// SPDX-License-Identifier: Apache-2.0
// The surface that a ball-shaped proxy touches: a distance field or triangles; and a wave texture on it.
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
    double step = 0.25e-3;  ///< m: maximum length of a step along a field; never more than half a voxel
};

/// Waves along the two axes of a body that lie best in its surface, each with half of the height.
struct ProxyTexture {
    /// Largest height over length: the steepest slope is then 0.9. A steeper wave is felt as a row of walls.
    static constexpr double max_ratio = 0.2;

    double height =
        0.0;  ///< m, from its mean, which is the surface, to the crest; counts up to `max_ratio` of the length
    double length = 2e-3;  ///< m, of a wave along each axis of the body

    double used_height() const noexcept { return std::max(0.0, std::min(height, max_ratio * length)); }
    /// Of the steepest place of a flat face, m/m.
    double max_slope() const noexcept;

    struct Lift {
        double height = 0.0;  ///< m above the mean
        Vec3 slope{0.0};  ///< its gradient, in the surface
    };
    /// At a point of a surface with this unit normal, both in the frame of the body.
    Lift at(const Vec3& point, const Vec3& normal) const noexcept;
};

/// One surface: its triangles if there are any, otherwise its distance field.
struct ProxySurface {
    using Budget = geometry::TriangleTree::Budget;

    const contact::Voxmap* map = nullptr;
    const geometry::TriangleTree* triangles = nullptr;
    Pose pose;

    /// A field seen from a position: one smooth surface.
    struct Level {
        bool seen = false;  ///< a direction out of the body was found
        ProxyPlane plane;
        double room = 0.0;  ///< m: a move of this length in any direction is free
    };

    /// Of a surface without triangles.
    Level level(const Vec3& at, const ProxyShape& shape) const noexcept;
    /// Maximum move beyond what is free, m; of a surface without triangles.
    double stride(const ProxyShape& shape) const noexcept;
    /// These two spend triangles of a budget. When it is spent, nothing is found and no move is free.
    /// Planes of all triangles that a ball at `at` touches, as those of the surface `index`.
    void touched(const Vec3& at, const ProxyShape& shape, std::size_t index, ProxyPlanes& into,
                 Budget& budget) const noexcept;
    /// Distance that a ball can move along the unit vector `direction` before it touches a triangle, m; at most
    /// `length`.
    double free_distance(const Vec3& at, const Vec3& direction, double length, const ProxyShape& shape,
                         Budget& budget) const noexcept;
};

inline constexpr double proxy_hover = 1e-7;  ///< m: distance at which a proxy is held off a surface
inline constexpr double proxy_touch = 3e-7;  ///< m: nearer surfaces count as touched

}  // namespace tactus::coupling
