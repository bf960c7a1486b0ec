// SPDX-License-Identifier: Apache-2.0
#include "tools/command/pose_text.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cstdio>

namespace tactus::command {

Pose pose_of_text(const std::string& text, std::string_view option) {
    double v[7];
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf%c", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6,
                    &rest) != 7)
        throw Error(fmt::format("{} takes X,Y,Z,QW,QX,QY,QZ: a position in mm and a unit quaternion", option));
    const Pose pose{1e-3 * Vec3(v[0], v[1], v[2]), Quat(v[3], v[4], v[5], v[6])};
    if (!is_valid(pose)) throw Error(fmt::format("{} needs finite numbers and a quaternion of unit length", option));
    return {pose.position, glm::normalize(pose.orientation)};
}

}  // namespace tactus::command
