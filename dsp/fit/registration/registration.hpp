// SPDX-License-Identifier: Apache-2.0
// Rigid registration of one surface to another of the same shape; for fractures see fit.hpp.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

struct RegistrationSettings {
    double widest = 20e-3, finest = 1e-3;  ///< m, scale of the robust kernel: points far beyond it have little weight
    int stages = 60;
    std::size_t max_points = 4000;  ///< maximum number of moving points, selected evenly from the list
    bool by_parts = false;  ///< a large part may be displaced: finds the pose that most of the surface supports
};

struct Registration {
    Pose pose;  ///< of the moving surface in the fixed one's frame
    double median = 0.0, p90 = 0.0;  ///< m, distances of the moving points from the fixed surface
    double before = 0.0;  ///< m, the median at the start
    double covered = 0.0;  ///< fraction of the moving points within twice the finest scale
};

/// Target of a registration. Distances refer to the tangent plane of the nearest point, because points are sparse.
class RegistrationTarget {
public:
    /// Throws Error without points.
    explicit RegistrationTarget(std::span<const contact::SurfacePoint> points);

    std::size_t nearest(const Vec3& place) const noexcept { return tree_.nearest(place); }
    /// The same, faster if the point `guess` is near.
    std::size_t nearest(const Vec3& place, std::size_t guess) const noexcept { return tree_.nearest(place, guess); }
    const Vec3& position(std::size_t n) const noexcept { return positions_[n]; }
    const Vec3& normal(std::size_t n) const noexcept { return normals_[n]; }
    /// Returns the distance in m of a position from the surface: to the nearest point's plane, or to the point if it is
    /// far away.
    double distance(const Vec3& place) const noexcept;

private:
    std::vector<Vec3> positions_, normals_;
    geometry::PointTree tree_;
};

/// Returns the median distance in m of the points at `pose` from the fixed surface. Throws Error without points.
double median_distance(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                       const Pose& pose);

/// Robust point-to-plane ICP with a narrowing scale, from `start`. Uses only points whose normal is within 60 degrees
/// of their target's normal. Throws Error without points. Deterministic.
Registration register_surface(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                              const Pose& start, const RegistrationSettings& settings = {});

/// Returns the best of registrations from 24 starts: centroids aligned, with all alignments of the principal axes and
/// rotations in between.
Registration register_from_anywhere(std::span<const contact::SurfacePoint> moving,
                                    std::span<const contact::SurfacePoint> fixed_points,
                                    const RegistrationTarget& fixed, const RegistrationSettings& settings = {});

enum class RegistrationVerdict : std::uint8_t {
    fit,  ///< one pose is clearly better than all others
    ambiguous,  ///< another pose fits about as well, as for a shape that is nearly symmetric
    none  ///< no pose brings the surfaces together
};

struct JudgedRegistration {
    Registration best;
    RegistrationVerdict verdict = RegistrationVerdict::none;
    double score = 0.0;  ///< m, root mean square distance of both surfaces at `best`, each distance limited
    struct Rival {
        Pose pose;
        double score = 0.0;  ///< m
    };
    std::vector<Rival> rivals;  ///< other poses, best first; for an ambiguous result those of similar quality
};

/// Searches from 24 starts as register_from_anywhere, and from `start` if it is not null, and compares the best pose
/// with the best of those more than 20 degrees or a quarter of the size away. The comparison is relative, because the
/// surface of another person never matches exactly: a fit must be at least a quarter better than any other pose. Among
/// poses of equal quality, the one from `start` is returned. If one surface is a part of the other, only its distances
/// count.
JudgedRegistration search_registration(std::span<const contact::SurfacePoint> moving,
                                       std::span<const contact::SurfacePoint> fixed_points,
                                       const RegistrationTarget& fixed, const Pose* start,
                                       const RegistrationSettings& settings = {});

/// Points of the moving surface at `pose` that are farther than `away` (m) from the fixed one: the largest connected
/// patch by area (gaps below `gap`), dilated by `margin`.
std::vector<std::size_t> displaced_region(std::span<const contact::SurfacePoint> moving, const Pose& pose,
                                          const RegistrationTarget& fixed, double away, double gap, double margin);

/// The largest patch of points within `away` (m) of the fixed surface at pose `own`, and nearer to it there than at
/// `rest` by `nearer` (m): all points that moved with a part of known pose.
std::vector<std::size_t> region_nearer(std::span<const contact::SurfacePoint> moving, const Pose& rest, const Pose& own,
                                       const RegistrationTarget& fixed, double nearer, double away, double gap);

}  // namespace tactus::fit
