// SPDX-License-Identifier: Apache-2.0
// Closed paths of a hand over a table whose top is z = 0: both ends are free of contact and equal.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

namespace tactus::test {

using Path = std::function<Pose(double)>;  ///< from 0 to 1, both ends free of contact and equal

struct Motion {
    const char* name;
    Path path;
};

/// Smooth from 0 at a to 1 at b.
inline double eased(double s, double a, double b) {
    const double u = std::clamp((s - a) / (b - a), 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

/// Closed paths of something whose lower end is at the pose, above a table whose top is z = 0; `depth` m.
inline std::vector<Motion> motions(double depth, double turn, const Quat& rest) {
    const double up = 4.0 * mm;
    const auto at = [rest](double x, double y, double z, const Vec3& w = Vec3(0.0)) {
        return Pose{{x, y, z}, rotation_by(w) * rest};
    };
    std::vector<Motion> all{
        {"press and release",
         [=](double s) { return at(0.0, 0.0, up - (up + depth) * (eased(s, 0.0, 0.5) - eased(s, 0.5, 1.0))); }},
        {"press, slide off the edge, come back above",
         [=](double s) {
             return at(20.0 * mm * (eased(s, 0.3, 0.6) - eased(s, 0.8, 1.0)), 1.3 * mm,
                       up - (up + depth) * (eased(s, 0.0, 0.3) - eased(s, 0.6, 0.8)));
         }},
        {"slide in over the edge, release, go back above",
         [=](double s) {
             return at(20.0 * mm * (eased(s, 0.0, 0.2) - eased(s, 0.4, 0.7)), 1.3 * mm,
                       up - (up + depth) * (eased(s, 0.2, 0.4) - eased(s, 0.7, 1.0)));
         }},
        {"press, turn, release, turn back",
         [=](double s) {
             return at(0.0, 0.0, up - (up + depth) * (eased(s, 0.0, 0.3) - eased(s, 0.6, 0.8)),
                       turn * Vec3(0.7, 1.0, 0.4) * (eased(s, 0.3, 0.6) - eased(s, 0.8, 1.0)));
         }},
        {"turn, press, turn back, release",
         [=](double s) {
             return at(0.0, 0.0, up - (up + depth) * (eased(s, 0.2, 0.4) - eased(s, 0.7, 1.0)),
                       turn * Vec3(0.7, 1.0, 0.4) * (eased(s, 0.0, 0.2) - eased(s, 0.4, 0.7)));
         }},
    };
    for (std::uint64_t n = 0; n < 12; ++n)
        all.push_back({"a random loop", [=](double s) {
                           const Random random{n + 1};
                           double v[6] = {};
                           for (std::uint64_t axis = 0; axis < 6; ++axis)
                               for (std::uint64_t h = 1; h <= 3; ++h)
                                   v[axis] += random.normal(10 * axis + h) / static_cast<double>(h) *
                                              std::sin(2.0 * std::numbers::pi * static_cast<double>(h) * s);
                           // Down in the middle, free at both ends.
                           const double in = eased(s, 0.0, 0.2) - eased(s, 0.8, 1.0);
                           return at(5.0 * mm * v[0] * in, 5.0 * mm * v[1] * in,
                                     up - in * (up + 0.5 * depth + 0.4 * depth * v[2]),
                                     0.6 * turn * in * Vec3(v[3], v[4], v[5]));
                       }});
    return all;
}

}  // namespace tactus::test
