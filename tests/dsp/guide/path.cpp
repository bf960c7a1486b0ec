// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/path.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/guide/box.hpp"
#include "dsp/guide/guide_law.hpp"
#include "dsp/guide/twist_angle.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

Vec3 some_vector(std::uint64_t n, double size = 1.0) {
    const Random random{7};
    return size * Vec3(random.normal(3 * n), random.normal(3 * n + 1), random.normal(3 * n + 2));
}

}  // namespace

TEST_CASE("the nearest place of a straight path is the nearest of all its points") {
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, -1}};
    const guide::Path path(corners, false, false);
    CHECK(path.length() == Approx(4.0));
    for (std::uint64_t n = 0; n < 200; ++n) {
        const Vec3 p = some_vector(n);
        double least = 1e9;
        for (std::size_t i = 0; i + 1 < corners.size(); ++i)
            for (int k = 0; k <= 1000; ++k)
                least = std::min(least, glm::distance(p, corners[i] + (corners[i + 1] - corners[i]) * (1e-3 * k)));
        CHECK(glm::distance(path.nearest(p).point, p) == Approx(least).margin(1e-5));
        CHECK(glm::distance(path.nearest(p).point, p) <= least + 1e-12);
    }
    CHECK(path.nearest({0.25, -1.0, 0.0}).along == Approx(0.25));
    CHECK(path.nearest({5.0, 1.0, 0.0}).along == Approx(2.0));
}

TEST_CASE("a smooth path goes through its points, and a circle of points is nearly a circle") {
    std::vector<Vec3> ring;
    for (int k = 0; k < 12; ++k) {
        const double a = 2.0 * std::numbers::pi * k / 12;
        ring.emplace_back(std::cos(a), std::sin(a), 0.0);
    }
    const guide::Path path(ring, true, true);
    for (const Vec3& p : ring) CHECK(glm::distance(path.nearest(p).point, p) < 1e-12);
    CHECK(path.length() == Approx(2.0 * std::numbers::pi).epsilon(0.01));
    for (int k = 0; k < 100; ++k) {
        const double a = 0.0628 * k;
        const Vec3 out(2.0 * std::cos(a), 2.0 * std::sin(a), 0.0);
        CHECK(glm::length(path.nearest(out).point) == Approx(1.0).epsilon(0.01));
    }
}

TEST_CASE("a path that is none is refused") {
    const auto refused = [](std::vector<Vec3> points, bool closed = false) {
        return guide::Path(points, true, closed);
    };
    CHECK_THROWS_WITH(refused({{0, 0, 0}}), ContainsSubstring("two points"));
    CHECK_THROWS_WITH(refused({{0, 0, 0}, {0, 0, 0}}), ContainsSubstring("differ"));
    CHECK_THROWS_WITH(refused({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, true), ContainsSubstring("differ"));
    CHECK_THROWS_WITH(refused(std::vector<Vec3>(201, Vec3(0.0))), ContainsSubstring("at most"));
}

TEST_CASE("spring and damper never exceed the largest force, and the spring stays what it is") {
    for (std::uint64_t n = 0; n < 500; ++n) {
        Vec3 spring = some_vector(3 * n), damper = some_vector(3 * n + 1, 3.0);
        const double most = 1.0;
        if (glm::length(spring) > most) spring /= glm::length(spring);
        const Vec3 sum = guide::limited_sum(spring, damper, most);
        CHECK(glm::length(sum) <= most * (1.0 + 1e-9));
        // A share of the damper, which takes energy whatever the share.
        const Vec3 taken = sum - spring;
        CHECK(glm::length(glm::cross(taken, damper)) < 1e-9 * (1.0 + glm::dot(damper, damper)));
        CHECK(glm::dot(taken, damper) >= -1e-12);
    }
}

TEST_CASE("the pull of a guide is the slope of an energy: no steeper than its stiffness, none beyond its reach") {
    const guide::GuideLaw law{.stiffness = 500.0, .damping = 0.0, .max_force = 1.0, .reach = 10e-3};
    CHECK(law.pull(1e-3) == Approx(0.5));
    CHECK(law.pull(5e-3) == Approx(1.0));
    CHECK(law.pull(9e-3) == Approx(0.5));
    CHECK(law.pull(10e-3) == 0.0);
    CHECK(law.pull(1.0) == 0.0);
    for (int k = 0; k < 1100; ++k) {
        const double d = 1e-5 * k;
        CHECK(std::abs(law.pull(d + 1e-5) - law.pull(d)) <= 500.0 * 1e-5 * (1.0 + 1e-6));
    }
}

TEST_CASE("a wall pushes, never pulls, and never beyond its largest force") {
    const guide::GuideLaw law{.stiffness = 500.0, .damping = 20.0, .max_force = 1.0};
    const Vec3 up(0.0, 0.0, 1.0);
    CHECK(law.repel(1e-3, up, {}).z == Approx(0.5));
    CHECK(law.repel(1e-3, up, {0.0, 0.0, -0.01}).z == Approx(0.7));
    CHECK(law.repel(1e-3, up, {0.0, 0.0, -1.0}).z == 1.0);
    CHECK(law.repel(1e-3, up, {0.0, 0.0, 1.0}).z == 0.0);
    CHECK(law.repel(-1e-3, up, {0.0, 0.0, -1.0}).z == 0.0);
    CHECK(law.repel(1.0, up, {}).z == 1.0);
}

TEST_CASE("the walls of a box are its nearest faces") {
    const Vec3 half(1.0, 2.0, 3.0);
    CHECK(guide::inside_of({0.9, 0.0, 0.0}, half).depth == Approx(0.1));
    CHECK(guide::inside_of({0.9, 0.0, 0.0}, half).normal == Vec3(1.0, 0.0, 0.0));
    CHECK(guide::inside_of({0.0, -1.95, 0.0}, half).normal == Vec3(0.0, -1.0, 0.0));
    CHECK(guide::inside_of({1.1, 0.0, 0.0}, half).depth == 0.0);
    CHECK(guide::outside_of({0.9, 0.0, 0.0}, half).depth == 0.0);
    const guide::WallContact corner = guide::outside_of({4.0, 6.0, 0.0}, half);
    CHECK(corner.depth == Approx(5.0));
    CHECK(corner.normal.x == Approx(-0.6));
    CHECK(corner.normal.y == Approx(-0.8));
}

TEST_CASE("the angle about an axis is that of the rotation about it, and its gradient is its rate") {
    const Vec3 axis = glm::normalize(Vec3(1.0, -2.0, 0.5));
    for (const double a : {-3.0, -1.0, 0.0, 0.4, 3.1})
        for (const double sign : {1.0, -1.0})
            CHECK(guide::twist_angle(rotation_by(a * axis) * sign, axis).angle == Approx(a).margin(1e-12));
    for (std::uint64_t n = 0; n < 50; ++n) {
        const Quat q = rotation_by(some_vector(n));
        const guide::TwistAngle at = guide::twist_angle(q, axis);
        for (int k = 0; k < 3; ++k) {
            Vec3 turn(0.0);
            turn[k] = 1e-6;
            const double slope = (guide::twist_angle(rotation_by(turn) * q, axis).angle -
                                  guide::twist_angle(rotation_by(-turn) * q, axis).angle) /
                                 2e-6;
            CHECK(at.gradient[k] == Approx(slope).margin(1e-5));
        }
    }
}
