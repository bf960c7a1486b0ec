// SPDX-License-Identifier: Apache-2.0
// Measures of a rope: reach, kinks, twist.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/rope/obstacle.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::rope {

/// Returns `count` points at equal distances along a polyline of at least two points.
std::vector<Vec3> resampled(std::span<const Vec3> line, std::size_t count);

double length_of(std::span<const Vec3> line) noexcept;

/// Returns the smallest radius of curvature at an inner point, m; infinity for a straight line.
double min_bend_radius(std::span<const Vec3> line) noexcept;

/// Transports a direction across the line's first segment to its last one without rotation about the line (Bishop
/// 1975): by the smallest rotation from segment to segment. A reversal of the line does not change the direction.
Vec3 transported(std::span<const Vec3> line, const Vec3& side) noexcept;

/// Twist of a rope whose ends are fixed to bodies: the angle between the last body's direction and the transported
/// direction of the first body. It counts beyond half turns as long as it changes by less than a half turn between two
/// calls.
class TwistCount {
public:
    /// Directions across the rope at its ends, fixed to the bodies. Returns rad, right-handed about the last segment,
    /// relative to the first call.
    double update(std::span<const Vec3> line, const Vec3& first_side, const Vec3& last_side) noexcept;

private:
    double offset_ = 0.0, total_ = 0.0;
    bool is_begun_ = false;
};

struct ShortestPath {
    std::vector<Vec3> points;
    double length = 0.0;  ///< m
    double change = 0.0;  ///< m: change in the last rounds; the remaining error is of this order
    bool is_settled = false;  ///< the change is below 0.1 % of the length
};

/// Returns the shortest line near `start` (at least two points) between its ends that keeps the distance `radius` from
/// the obstacle: a rubber band of `count` points without friction, which contracts until its length converges. It finds
/// the local optimum on the side of the obstacle on which it starts, not always the global one. Allocates. `obstacle`
/// may be null.
ShortestPath shortest_path(std::span<const Vec3> start, const Obstacle* obstacle, double radius,
                           std::size_t count = 65);

}  // namespace tactus::rope
