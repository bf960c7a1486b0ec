// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/snap_peers.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::bench {

namespace {

constexpr int max_iterations = 100, annealed_iterations = 60;
constexpr double trimmed_share = 0.8, widest = 8e-3, finest = 0.8e-3;
constexpr double flatness = 1e-3;  // variance along the normal relative to the plane, as in GICP

struct Match {
    std::size_t from, to;
    double distance2;
};

/// Weight of a pair's difference: identity, normal only, or the covariances of both planes.
Mat3 weighing(IcpKind kind, const Vec3& fixed_normal, const Vec3& moving_normal) {
    if (kind == IcpKind::point) return Mat3(1.0);
    if (kind == IcpKind::plane) return glm::outerProduct(fixed_normal, fixed_normal);
    const auto covariance = [](const Vec3& n) { return Mat3(1.0) - (1.0 - flatness) * glm::outerProduct(n, n); };
    return glm::inverse(covariance(fixed_normal) + covariance(moving_normal));
}

double threshold_of(IcpSchedule schedule, int iteration) {
    if (schedule != IcpSchedule::annealed) return std::numeric_limits<double>::infinity();
    const double progress = std::min(1.0, static_cast<double>(iteration) / (annealed_iterations - 1));
    return widest * std::pow(finest / widest, progress);
}

}  // namespace

std::string_view name_of(IcpKind kind) {
    constexpr std::string_view names[] = {"icp_point", "icp_plane", "gicp"};
    return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(IcpSchedule schedule) {
    constexpr std::string_view names[] = {"unlimited", "trimmed", "annealed"};
    return names[static_cast<std::size_t>(schedule)];
}

Pose run_icp(const fit::FitSurface& moving, const IcpTarget& target, const Pose& start, IcpKind kind,
             IcpSchedule schedule) {
    const fit::FitSurface& fixed = target.surface();
    Pose pose = start;
    std::vector<Match> matches(moving.position.size());
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        const Mat3 turn = glm::mat3_cast(pose.orientation);
        for (std::size_t i = 0; i < matches.size(); ++i) {
            const Vec3 x = pose.position + turn * moving.position[i];
            const std::size_t to = target.nearest(x);
            const Vec3 apart = x - fixed.position[to];
            matches[i] = {i, to, glm::dot(apart, apart)};
        }
        double most = threshold_of(schedule, iteration);
        if (schedule == IcpSchedule::trimmed) {
            std::vector<double> all;
            for (const Match& m : matches) all.push_back(m.distance2);
            const auto rank = static_cast<std::ptrdiff_t>(trimmed_share * static_cast<double>(all.size() - 1));
            std::nth_element(all.begin(), all.begin() + rank, all.end());
            most = std::sqrt(all[static_cast<std::size_t>(rank)]);
        }
        geometry::Matrix6 k{};
        geometry::Vector6 push{}, step{};
        for (const Match& m : matches) {
            if (!(m.distance2 <= most * most)) continue;
            const Vec3 arm = turn * moving.position[m.from];
            const Mat3 w = weighing(kind, fixed.normal[m.to], turn * moving.normal[m.from]);
            const Vec3 force = w * (pose.position + arm - fixed.position[m.to]);
            const Vec3 torque = glm::cross(arm, force);
            // Jacobian of the motion of x: the axes, and each axis crossed with the arm.
            Vec3 motion[6];
            for (int a = 0; a < 3; ++a) {
                motion[a] = Vec3(a == 0, a == 1, a == 2);
                motion[a + 3] = glm::cross(motion[a], arm);
                push[static_cast<std::size_t>(a)] -= force[a];
                push[static_cast<std::size_t>(a) + 3] -= torque[a];
            }
            for (std::size_t a = 0; a < 6; ++a) {
                const Vec3 weighed = w * motion[a];
                for (std::size_t b = 0; b < 6; ++b) k[6 * a + b] += glm::dot(weighed, motion[b]);
            }
        }
        if (!geometry::solve_symmetric6(k, push, step)) break;
        const Vec3 way(step[0], step[1], step[2]), spin(step[3], step[4], step[5]);
        pose = {pose.position + way, glm::normalize(rotation_by(spin) * pose.orientation)};
        const bool still = glm::length(way) + glm::length(spin) * moving.gyration < 1e-7;
        if (still && (schedule != IcpSchedule::annealed || iteration >= annealed_iterations)) break;
    }
    return pose;
}

}  // namespace tactus::bench
