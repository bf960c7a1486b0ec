// SPDX-License-Identifier: Apache-2.0
// Lays one surface on another of the same shape: a registration, not a fit of fractures.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

struct RegistrationSettings {
    double widest = 20e-3, finest = 1e-3;  ///< m, scale of the robust kernel: what lies far beyond it hardly pulls
    int stages = 60;
    std::size_t most_points = 4000;  ///< of the moving surface that take part, spread over the list
    bool by_parts = false;  ///< much of it may lie elsewhere than the rest: the place that most of it agrees on
};

struct Registration {
    Pose pose;  ///< of the moving surface in the fixed one's frame
    double median = 0.0, p90 = 0.0;  ///< m, distances of the moving points from the fixed surface
    double before = 0.0;             ///< m, the median where it started
    double covered = 0.0;            ///< share of the moving points within twice the finest scale
};

/// What is registered to. Distances are to the tangent plane of the nearest point, for points are sparse.
class RegistrationTarget {
public:
    /// Throws Error without points.
    explicit RegistrationTarget(std::span<const contact::SurfacePoint> points);

    std::size_t nearest(const Vec3& place) const noexcept { return tree_.nearest(place); }
    const Vec3& position(std::size_t n) const noexcept { return positions_[n]; }
    const Vec3& normal(std::size_t n) const noexcept { return normals_[n]; }
    /// m, of a place from the surface: to the nearest point's plane, or to the point when it is far from it.
    double distance(const Vec3& place) const noexcept;

private:
    std::vector<Vec3> positions_, normals_;
    geometry::PointTree tree_;
};

/// m, median distance of the points at `pose` from the fixed surface. Throws Error without points.
double median_distance(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed, const Pose& pose);

/// Robust point-to-plane registration with a scale that narrows, from `start`. A point counts only where its normal is
/// within 60 degrees of the one it is laid on. Throws Error without points. Deterministic.
Registration register_surface(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed, const Pose& start,
                              const RegistrationSettings& settings = {});

/// The best of registrations from 24 starts: middles on each other, main axes along each other in all ways and between.
Registration register_from_anywhere(std::span<const contact::SurfacePoint> moving, std::span<const contact::SurfacePoint> fixed_points,
                                    const RegistrationTarget& fixed, const RegistrationSettings& settings = {});

/// Points of the moving surface at `pose` that lie farther than `away` (m) from the fixed one and hang together with
/// gaps below `gap`: the largest such patch by area, grown by `margin` over its neighbours.
std::vector<std::size_t> displaced_region(std::span<const contact::SurfacePoint> moving, const Pose& pose,
                                          const RegistrationTarget& fixed, double away, double gap, double margin);

/// The largest patch of points that lie within `away` (m) of the fixed surface at pose `own`, and nearer to it there than
/// at `rest` by `nearer` (m): all that moved with a part whose place is known.
std::vector<std::size_t> region_nearer(std::span<const contact::SurfacePoint> moving, const Pose& rest, const Pose& own,
                                       const RegistrationTarget& fixed, double nearer, double away, double gap);

}  // namespace tactus::fit
