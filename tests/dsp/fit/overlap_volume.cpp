// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/gap.hpp"
#include "tests/support/catch.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

using namespace tactus;

namespace {

constexpr double mm3 = 1e-9;
constexpr double radius = 8.0 * mm;
const Vec3 sides(6.0 * mm, 8.0 * mm, 7.0 * mm);  // half of them

using Distance = std::function<double(const Vec3&)>;

volume::Grid grid_of(const Distance& distance) {
    volume::Grid grid;
    grid.spacing = Vec3(0.5 * mm, 0.6 * mm, 0.45 * mm);
    for (int axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = -12.6 * mm;
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(25.2 * mm / grid.spacing[axis]) + 1;
    }
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.values.push_back(static_cast<float>(distance(grid.position(i, j, k))));
    return grid;
}

double box(const Vec3& p) {
    const Vec3 off = glm::abs(p) - sides;
    return glm::length(glm::max(off, Vec3(0.0))) + std::min(0.0, std::max({off.x, off.y, off.z}));
}

double ball(const Vec3& p) { return glm::length(p) - radius; }

/// How the samples of the second lie in the frame of its body, and where both bodies lie.
const Quat samples[] = {{1.0, 0.0, 0.0, 0.0}, rotation_by(Vec3(0.4, -0.7, 0.2)), rotation_by(Vec3(0.0, 0.0, 0.785))};
const Pose place{Vec3(3.3 * mm, -1.7 * mm, 20.0 * mm), rotation_by(Vec3(-0.2, 0.5, 1.1))};

/// m³ in both when the second body is `apart` from the first, in the frame of the first.
double both(const Distance& first, const Distance& second, const Quat& turn, const Vec3& apart) {
    const volume::Grid turned = grid_of([&](const Vec3& p) { return second(turn * p); });
    return fit::overlap_volume(grid_of(first), place, contact::make_voxmap(turned), place * Pose{apart, turn});
}

}  // namespace

TEST_CASE("dsp: boxes that only touch have no volume in common, and others that of the box in both") {
    const double face = 4.0 * sides.y * sides.z;
    for (const Quat& turn : samples)
        for (const double deep : {0.0, 0.1 * mm, 0.4 * mm, 1.0 * mm, 3.0 * mm})
            for (const double aside : {0.0, 0.17 * mm}) {
                CAPTURE(deep / mm, aside / mm, turn.w);
                const double exact = deep * (2.0 * sides.y - aside) * 2.0 * sides.z;
                const double found = both(box, box, turn, {2.0 * sides.x - deep, aside, 0.0});
                // 0.05 mm over the face; a quarter of a voxel was 0.13 mm.
                CHECK(found / mm3 == Approx(exact / mm3).margin(0.05 * mm * face / mm3));
            }
}

TEST_CASE("dsp: balls that touch have no volume in common, and others that of the lens in both") {
    for (const Vec3& way : {Vec3(1.0, 0.0, 0.0), glm::normalize(Vec3(1.0, 2.0, -1.5))})
        for (const double apart : {16.0 * mm, 15.5 * mm, 14.0 * mm, 9.0 * mm, 2.0 * mm}) {
            CAPTURE(apart / mm, way.x);
            const double exact =
                std::numbers::pi * (4.0 * radius + apart) * (2.0 * radius - apart) * (2.0 * radius - apart) / 12.0;
            CHECK(both(ball, ball, samples[1], apart * way) / mm3 == Approx(exact / mm3).epsilon(0.02).margin(0.5));
        }
}

TEST_CASE("dsp: a ball in a box, turned against it, has its own volume in common with it") {
    const Pose turned{Vec3(0.2 * mm, 0.0, 0.1 * mm), rotation_by(Vec3(0.3, 0.2, -0.5))};
    const volume::Grid outer = grid_of(box), inner = grid_of([](const Vec3& p) { return glm::length(p) - 5.0 * mm; });
    const double exact = 4.0 / 3.0 * std::numbers::pi * 125.0;
    CHECK(fit::overlap_volume(inner, turned, contact::make_voxmap(outer), {}) / mm3 == Approx(exact).epsilon(0.01));
    CHECK(fit::overlap_volume(outer, {}, contact::make_voxmap(inner), turned) / mm3 == Approx(exact).epsilon(0.01));
}
