// SPDX-License-Identifier: Apache-2.0
// Common variants of iterative closest point (ICP), as baselines for snap-to-fit.
#pragma once

#include "dsp/fit/fit_surface.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <string_view>
#include <vector>

namespace tactus::bench {

/// Point to point (Besl and McKay 1992), point to plane (Chen and Medioni 1992), plane to plane (GICP, Segal 2009).
enum class IcpKind { point, plane, generalised };
/// Pair selection: all, the nearest 80 % (trimmed), or those within a threshold that decreases from 8 mm to 0.8 mm.
enum class IcpSchedule { unlimited, trimmed, annealed };

std::string_view name_of(IcpKind kind);
std::string_view name_of(IcpSchedule schedule);

/// Nearest neighbours from a k-d tree of the painted points of the fixed side.
class IcpTarget {
public:
    explicit IcpTarget(const fit::FitSurface& fixed) : surface_(fixed), tree_(fixed.position) {}

    const fit::FitSurface& surface() const { return surface_; }
    std::size_t nearest(const Vec3& position) const { return tree_.nearest(position); }

private:
    const fit::FitSurface& surface_;
    geometry::PointTree tree_;
};

/// Iterates from `start` (relative to the centres of the paints) to convergence, at most 100 iterations.
Pose run_icp(const fit::FitSurface& moving, const IcpTarget& fixed, const Pose& start, IcpKind kind,
             IcpSchedule schedule);

}  // namespace tactus::bench
