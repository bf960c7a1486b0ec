// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/point_registration.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tactus::fit {

PointRegistration register_points(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                                  const Pose& start, double share) {
    if (moving.empty()) throw Error("there is no surface to register");
    PointRegistration made{start, 0.0, 0.0, 0};
    struct Match {
        Vec3 from, to;
        double distance;
    };
    std::vector<Match> matches(moving.size());
    const auto count = std::max<std::size_t>(3, static_cast<std::size_t>(share * static_cast<double>(moving.size())));
    for (; made.steps < 200; ++made.steps) {
        for (std::size_t n = 0; n < moving.size(); ++n) {
            const Vec3 x = made.pose.apply(moving[n].position), y = fixed.position(fixed.nearest(x));
            matches[n] = {x, y, glm::length(x - y)};
        }
        std::ranges::stable_sort(matches, {}, &Match::distance);
        matches.resize(std::min(count, matches.size()));
        Vec3 centre(0.0);
        for (const Match& m : matches) centre += m.from / static_cast<double>(matches.size());
        geometry::Matrix6 k{};
        geometry::Vector6 push{}, step{};
        for (const Match& m : matches) {
            const Vec3 arm = m.from - centre, difference = m.to - m.from, torque = glm::cross(arm, difference);
            const Mat3 inertia = glm::dot(arm, arm) * Mat3(1.0) - glm::outerProduct(arm, arm);
            for (int a = 0; a < 3; ++a) {
                const auto row = static_cast<std::size_t>(a);
                push[row] += difference[a];
                push[row + 3] += 1e3 * torque[a];
                k[7 * row] += 1.0;
                for (int b = 0; b < 3; ++b) k[6 * (row + 3) + static_cast<std::size_t>(b) + 3] += 1e6 * inertia[b][a];
            }
        }
        matches.resize(moving.size());
        if (!geometry::solve_symmetric6(k, push, step)) break;
        const Vec3 translation(step[0], step[1], step[2]), rotation = 1e3 * Vec3(step[3], step[4], step[5]);
        const Quat spin = rotation_by(rotation);
        made.pose = {centre + translation + spin * (made.pose.position - centre),
                     glm::normalize(spin * made.pose.orientation)};
        if (glm::length(translation) < 1e-7 && glm::length(rotation) < 1e-6) break;
    }
    std::vector<double> to_points, to_surface;
    for (const contact::SurfacePoint& p : moving) {
        const Vec3 x = made.pose.apply(p.position);
        to_points.push_back(glm::length(x - fixed.position(fixed.nearest(x))));
        to_surface.push_back(fixed.distance(x));
    }
    for (auto* all : {&to_points, &to_surface}) {
        const auto middle = all->begin() + static_cast<std::ptrdiff_t>(all->size() / 2);
        std::nth_element(all->begin(), middle, all->end());
        (all == &to_points ? made.to_points : made.to_surface) = *middle;
    }
    return made;
}

}  // namespace tactus::fit
