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

bool has_bound(fit::FitVerdict verdict) {
    return verdict == fit::FitVerdict::fit || verdict == fit::FitVerdict::uncertain;
}

std::string bound_words(fit::FitVerdict verdict, const fit::PoseBound& bound) {
    return fmt::format(
        "{}: its place is known to ±{:.2f}°, ±{:.2f} mm at the face and ±{:.2f} mm at the far end (95 %){}",
        fit::answer_of(verdict), bound.turn * 180.0 / std::numbers::pi, bound.face * 1e3, bound.far * 1e3,
        bound.has_rival ? "; another pose that fits less well is within that" : "");
}

std::string left_out_words(std::string_view name, double area) {
    return fmt::format(
        "{}: {:.0f} mm² touch another fragment in the scan; they are left out of fits, as they show where it was "
        "scanned",
        name, area * 1e6);
}

}  // namespace tactus::command
