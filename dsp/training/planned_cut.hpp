// SPDX-License-Identifier: Apache-2.0
// A planned cut of a saw, and where a point or a blade is with respect to it.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

namespace tactus::training {

/// A saw blade: x along the stroke, y into the bone, origin in the middle of the tooth edge, as all blades of a patch.
struct BladeSize {
    double length = 40e-3;  ///< m, of the tooth edge
    double height = 10e-3;  ///< m, from the teeth back
    double kerf = 1e-3;     ///< m, width of the cut
    double stroke = 3e-3;   ///< m, of the reciprocation, peak to peak
};

/// A flat cut. The three directions are unit vectors and orthogonal: stroke × feed = normal.
struct PlannedCut {
    std::string name;  ///< of one cut among several; may be empty
    Vec3 point{0.0, 0.0, 0.0};   ///< where the middle of the tooth edge enters the bone, m
    Vec3 feed{0.0, 0.0, -1.0};   ///< into the bone
    Vec3 stroke{1.0, 0.0, 0.0};  ///< along the blade
    Vec3 normal{0.0, 1.0, 0.0};  ///< of the planned plane
    double half_length = std::numeric_limits<double>::infinity();  ///< m, of a line, to both sides of `point`
    double depth = 0.02;              ///< m along `feed` from `point`: the depth stop
    double tolerance = 1e-3;          ///< m, across the plane and beyond the ends of a line
    double depth_tolerance = 1e-3;    ///< m beyond the depth stop
    double angle_tolerance = 0.0873;  ///< rad

    /// Coordinates of a point: along the stroke, along the feed, and across the plane; m.
    Vec3 coordinates(const Vec3& p) const noexcept {
        const Vec3 d = p - point;
        return {glm::dot(d, stroke), glm::dot(d, feed), glm::dot(d, normal)};
    }
    Vec3 position(double along, double down, double across = 0.0) const noexcept {
        return point + along * stroke + down * feed + across * normal;
    }
    /// Axes of a blade that stands in the plan: x along the stroke, y along the feed.
    Mat3 axes() const noexcept { return {stroke, feed, normal}; }
};

/// m from a point to a planned cut. A plane counts within 30 mm of its entry, as others of the same bone may cross it farther
/// away.
inline double distance_to_cut(const PlannedCut& cut, const Vec3& p) noexcept {
    constexpr double wide = 30e-3;  // m
    const Vec3 at = cut.coordinates(p);
    return std::hypot(at.z, std::max(0.0, std::hypot(at.x, at.y) - wide));
}

/// Index of the cut whose plane is nearest to a point; at least one cut.
inline std::size_t nearest_cut(std::span<const PlannedCut> cuts, const Vec3& p) noexcept {
    std::size_t nearest = 0;
    for (std::size_t n = 1; n < cuts.size(); ++n)
        if (distance_to_cut(cuts[n], p) < distance_to_cut(cuts[nearest], p)) nearest = n;
    return nearest;
}

/// Angle between two planes of unit normals, 0 to π/2.
inline double angle_between_planes(const Vec3& a, const Vec3& b) noexcept {
    // atan2 keeps small angles exact, where acos loses half of the digits.
    return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b)));
}

/// Index of the cut that a blade makes; at least one cut. Where two planes cross, the angle decides: 1 rad counts as 10 mm.
inline std::size_t nearest_cut(std::span<const PlannedCut> cuts, const Pose& blade) noexcept {
    constexpr double lever = 10e-3;  // m
    const Vec3 normal = blade.rotate(Vec3(0.0, 0.0, 1.0));
    const auto away = [&](const PlannedCut& cut) {
        return distance_to_cut(cut, blade.position) + lever * angle_between_planes(cut.normal, normal);
    };
    std::size_t nearest = 0;
    for (std::size_t n = 1; n < cuts.size(); ++n)
        if (away(cuts[n]) < away(cuts[nearest])) nearest = n;
    return nearest;
}

/// A blade against the plan.
struct CutDeviation {
    double distance = 0.0;  ///< m, of the middle of the tooth edge from the planned plane, signed along its normal
    double angle = 0.0;  ///< rad, between the blade and the planned plane
    double depth = 0.0;  ///< m along the feed from the planned entry: see edge_depth
};

/// Depth of the deepest point of the tooth edge that stands between `low` and `high` (m along the planned stroke); of
/// its middle where that range has no end or the edge is not in it.
inline double edge_depth(const PlannedCut& cut, const BladeSize& blade, const Pose& pose, double low,
                         double high) noexcept {
    const Vec3 middle = cut.coordinates(pose.position), x = pose.rotate(Vec3(1.0, 0.0, 0.0));
    const double slope = glm::dot(x, cut.feed), along = glm::dot(x, cut.stroke);
    if (!std::isfinite(low) || !std::isfinite(high) || std::abs(along) < 0.1) return middle.y;
    const double half = 0.5 * blade.length;
    const double one = (low - middle.x) / along, other = (high - middle.x) / along;
    const double from = std::max(std::min(one, other), -half), to = std::min(std::max(one, other), half);
    return from > to ? middle.y : middle.y + std::max(from * slope, to * slope);
}

inline CutDeviation deviation_of(const PlannedCut& cut, const BladeSize& blade, const Pose& pose) noexcept {
    return {cut.coordinates(pose.position).z, angle_between_planes(cut.normal, pose.rotate(Vec3(0.0, 0.0, 1.0))),
            edge_depth(cut, blade, pose, -cut.half_length, cut.half_length)};
}

}  // namespace tactus::training
