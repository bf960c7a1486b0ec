// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/clip_place.hpp"

#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>

using namespace tactus;
using namespace tactus::window;

TEST_CASE("a clip through a point goes through it whatever its direction") {
    display::Bounds bounds;
    bounds.add({-0.02, -0.05, 0.01});
    bounds.add({0.04, 0.03, 0.09});
    const Vec3 points[] = {{0.031, -0.044, 0.02}, {0.0, 0.01, 0.05}, {-0.015, 0.0, 0.085}};
    const Vec3 normal = glm::normalize(glm::cross(points[1] - points[0], points[2] - points[0]));
    for (const Vec3& direction : {normal, -normal, Vec3(0.0, 0.0, 1.0)}) {
        const double share = share_through(bounds, direction, points[0]);
        const display::Plane plane = plane_at(bounds, direction, share);
        CHECK(std::abs(glm::dot(points[0] - plane.point, plane.normal)) < 1e-12);
        CHECK(share > 0.0);
        CHECK(share < 1.0);
    }
    const display::Plane plane = plane_at(bounds, normal, share_through(bounds, normal, points[0]));
    for (const Vec3& point : points) CHECK(std::abs(glm::dot(point - plane.point, normal)) < 1e-12);
    const auto [low, high] = extent_along(bounds, {0.0, 0.0, 1.0});
    CHECK(low == 0.01);
    CHECK(high == 0.09);
}
