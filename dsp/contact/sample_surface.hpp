// SPDX-License-Identifier: Apache-2.0
// Blue-noise sampling of surfaces, for pointshells.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::contact {

/// Density of sampling.
struct SurfaceSampling {
    double spacing = 0.5e-3;  ///< m: a flat surface gets about one point per spacing²
    /// Where normals turn by more than `max_turn` within one spacing, points are proportionally denser, down to a
    /// third of the spacing.
    bool follow_curvature = false;
    double max_turn = 0.35;  ///< rad
    std::uint64_t seed = 1;
    std::size_t max_points = 2'000'000;
};

/// Blue-noise points: no two on one side of the surface are nearer than 0.77 spacings, and no further point fits. The
/// areas of the points sum to the area of the surface. Normals are those of the triangles, outwards. Deterministic for
/// the same surface and options. Throws Error when the spacing is not positive, or so fine that there would be more
/// than `max_points`. The result does not depend on how jobs are run.
std::vector<SurfacePoint> sample_surface(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling,
                                         const RunJobs& run = run_in_turn);

/// Samples the zero surface of a signed distance (m, negative inside): points lie on the zero level of the trilinear
/// interpolant, normals are its smoothed gradient. Empty if the field does not cross zero.
std::vector<SurfacePoint> sample_surface(const volume::Grid& distance, const SurfaceSampling& sampling,
                                         const RunJobs& run = run_in_turn);

/// Labels points that face another body: within `reach` (m) of its surface, with a normal opposite to the other's
/// within `max_angle` (rad). Use: finding the fracture surfaces of fragments near their fitted poses. `into_map` maps
/// the points' frame to the map's. Returns the number of labelled points.
std::size_t label_facing(std::span<SurfacePoint> points, const Voxmap& other, const Pose& into_map, double reach,
                         double max_angle, std::uint8_t label = surface_label::fracture);

}  // namespace tactus::contact
