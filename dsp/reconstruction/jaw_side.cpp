// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/jaw_side.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/plan_frame.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>

namespace tactus::reconstruction {

namespace {

constexpr double min_segment = 1.0 * mm;
constexpr std::size_t max_planes = 6;

std::string nth(std::size_t plane) { return fmt::format("plane {}", plane + 1); }

Vec3 y_of(const JawPlane& given, const Vec3& normal, const Vec3& axis, std::size_t n) {
    const Vec3 superior(0.0, 0.0, 1.0);
    const Vec3 level = superior - glm::dot(superior, normal) * normal;
    if (!given.y && glm::length(level) < min_y)
        throw Error(fmt::format("{} is nearly horizontal: give it a y, which tells how its segment is turned", nth(n)));
    const Vec3 y = direction(given.y ? *given.y : level, nth(n) + ": its y");
    if (glm::length(glm::cross(y, axis)) < min_y)
        throw Error(fmt::format("{}: {} is parallel to the segment after it: give it {}", nth(n),
                                given.y ? "its y" : "superior", given.y ? "another y" : "a y"));
    return y;
}

}  // namespace

JawSide jaw_side(const FibulaInputs& inputs) {
    const std::size_t count = inputs.planes.size();
    if (count < 2 || count > max_planes)
        throw Error(
            fmt::format("{} planes: a plan needs 2 to {}, for one to {} segments", count, max_planes, max_planes - 1));
    JawSide jaw;
    for (std::size_t n = 0; n + 1 < count; ++n) {
        const Vec3 along = inputs.planes[n + 1].origin - inputs.planes[n].origin;
        if (!is_finite(along) || !(glm::length(along) >= min_segment))
            throw Error(fmt::format("{} and {}: their origins are less than 1 mm apart", nth(n), nth(n + 1)));
        jaw.axis.push_back(glm::normalize(along));
    }
    for (std::size_t n = 0; n < count; ++n) {
        const JawPlane& given = inputs.planes[n];
        const bool is_end = n == 0 || n + 1 == count;
        const Vec3 before = jaw.axis[n == 0 ? 0 : n - 1], after = jaw.axis[std::min(n, jaw.axis.size() - 1)];
        if (!given.normal && is_end) throw Error(fmt::format("{}: a plane at an end needs a normal", nth(n)));
        const Vec3 bisector = direction(before + after, nth(n) + ": the bisecting normal");
        Vec3 normal = given.normal ? direction(*given.normal, nth(n) + ": the normal") : bisector;
        if (glm::dot(normal, bisector) < 0.0) normal = -normal;
        for (const Vec3& axis : {before, after})
            if (angle_between(normal, axis) > max_tilt)
                throw Error(fmt::format("{}: it is tilted by {:.1f}° against a segment; at most {:.0f}°", nth(n),
                                        angle_between(normal, axis) / degree, max_tilt / degree));
        jaw.planes.push_back({given.origin, normal});
        if (n + 1 < count) jaw.y.push_back(y_of(given, normal, after, n));
        if (!is_end) jaw.off_bisector.push_back(angle_between(normal, bisector));
    }
    if (inputs.reversed) {
        std::ranges::reverse(jaw.planes);
        std::ranges::reverse(jaw.axis);
        std::ranges::reverse(jaw.y);
        for (Plane& plane : jaw.planes) plane.normal = -plane.normal;
        for (Vec3& axis : jaw.axis) axis = -axis;
    }
    return jaw;
}

}  // namespace tactus::reconstruction
