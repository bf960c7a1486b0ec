// SPDX-License-Identifier: Apache-2.0
// Points spread evenly over a surface: what pointshells are made of.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::contact {

/// How densely a surface is sampled.
struct SurfaceSampling {
    double spacing = 0.5e-3;  ///< m: a flat surface gets about one point per spacing²
    /// Where the surface turns by more than `most_turn` within one spacing, points come closer together in proportion,
    /// down to a third of the spacing.
    bool follow_curvature = false;
    double most_turn = 0.35;  ///< rad
    std::uint64_t seed = 1;
    std::size_t most_points = 2'000'000;
};

/// Blue-noise points: no two on one side of the surface nearer than 0.77 spacings, and no room for another. Areas are
/// shares of the surface that add up to it. Normals are those of the triangles, which look outwards. The same surface
/// and options give the same points. Throws Error when the spacing is not positive, or so fine that there would be more
/// than `most_points`.
std::vector<SurfacePoint> sample_surface(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling);

/// On the zero surface of a signed distance (m, negative inside): points lie on the zero of the trilinear interpolant,
/// normals are its smoothed gradient. No points when nothing crosses zero.
std::vector<SurfacePoint> sample_surface(const volume::Grid& distance, const SurfaceSampling& sampling);

/// Labels points that face another body: within `reach` of its surface (m), with a normal that looks against the
/// other's within `most_angle` (rad). So fragments near their fitted places find their fracture surfaces. `into_map`
/// takes the points' frame to the map's. Returns how many were labelled.
std::size_t label_facing(std::span<SurfacePoint> points, const Voxmap& other, const Pose& into_map, double reach,
                         double most_angle, std::uint8_t label = surface_label::fracture);

}  // namespace tactus::contact
