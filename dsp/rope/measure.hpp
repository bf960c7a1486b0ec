// SPDX-License-Identifier: Apache-2.0
// What is read off a rope: reach, kinks, twist.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/rope/obstacle.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::rope {

/// `count` points at equal distances along a polyline of at least two points.
std::vector<Vec3> resampled(std::span<const Vec3> line, std::size_t count);

double length_of(std::span<const Vec3> line) noexcept;

/// Least radius of curvature at an inner point, m; infinity for a straight line.
double least_bend_radius(std::span<const Vec3> line) noexcept;

/// A direction across the line's first segment, carried to its last one without turning about the line (Bishop 1975):
/// by the least rotation from segment to segment. Doubling back is carried as it is.
Vec3 transported(std::span<const Vec3> line, const Vec3& side) noexcept;

/// Twist of a rope whose ends are fixed to bodies: the angle of the last body's direction against the transported one
/// of the first body, counted beyond half turns as long as it changes by less than a half turn between two calls.
class TwistCount {
public:
    /// Directions across the rope at its ends, fixed to the bodies. Returns rad, right-handed about the last segment;
    /// the first call gives 0, as both are taken as they are.
    double update(std::span<const Vec3> line, const Vec3& first_side, const Vec3& last_side) noexcept;

private:
    double offset_ = 0.0, total_ = 0.0;
    bool is_begun_ = false;
};

struct ShortestPath {
    std::vector<Vec3> points;
    double length = 0.0;  ///< m
    double change = 0.0;  ///< m: by how much it changed in the last rounds; the error that is left is of this order
    bool is_settled = false;  ///< the change is below 0.1 % of the length
};

/// The shortest line near `start` (at least two points) between its ends that keeps `radius` from the obstacle: a
/// rubber band without friction, of `count` points, that contracts until its length stands still. It stays on the side
/// on which it starts: not always the shortest of all. Allocates. `obstacle` may be null.
ShortestPath shortest_path(std::span<const Vec3> start, const Obstacle* obstacle, double radius,
                           std::size_t count = 65);

}  // namespace tactus::rope
