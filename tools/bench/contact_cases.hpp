// SPDX-License-Identifier: Apache-2.0
// Cases of `bench contact`: a spherical pointshell against the distance field of a ball, with a new pose in each frame.
#pragma once

#include "dsp/contact/contact_law.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <time.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tactus::bench {

inline constexpr double voxel = 0.35e-3;  // m
inline constexpr double cover = 0.3e-3;  // m, from a shell within the ball to its surface

struct Case {
    const char* name;
    int points;
    double radius;  ///< radius of the shell, in voxels
    double distance;  ///< distance of the centres, in radii: 0 for a shell within the ball, 2 for two touching balls
    contact::Interpolation interpolation = contact::Interpolation::trilinear;
    std::size_t budget = std::numeric_limits<std::size_t>::max();

    /// Radius of the ball, m.
    double ball() const { return radius * voxel + (distance > 0.0 ? 0.0 : cover); }
};

/// A random pose of the shell, 0.1 to 0.2 mm deep, independent of the previous frame.
inline Pose pose_of(const Case& c, std::uint64_t frame) {
    const Random random{7};
    const auto normal = [&](std::uint64_t n) { return random.normal(16 * frame + n); };
    const Quat turn = glm::normalize(Quat(normal(0), normal(1), normal(2), normal(3)));
    const Vec3 way = glm::normalize(Vec3(normal(4), normal(5), normal(6)));
    const double press = 1e-4 * (1.0 + random.uniform(16 * frame + 7));
    return {way * (c.distance > 0.0 ? c.distance * c.radius * voxel - press : 0.5 * press), turn};
}

inline double percentile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace tactus::bench
