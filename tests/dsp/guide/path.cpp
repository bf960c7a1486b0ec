// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/path.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/guide/box.hpp"
#include "dsp/guide/guide_law.hpp"
#include "dsp/guide/turning_pull.hpp"
#include "dsp/guide/twist_angle.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
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
    // The damper sets in with the depth.
    CHECK(law.repel(1e-8, up, {0.0, 0.0, -1.0}).z < 2e-3);
    CHECK(law.repel(0.1e-3, up, {0.0, 0.0, -0.01}).z == Approx(0.05 + 0.1));
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

TEST_CASE("the wall within a box turns from face to face no faster than its stiffness allows, and keeps its energy") {
    const Vec3 half(0.05, 0.03, 0.02);
    const guide::GuideLaw law{.stiffness = 500.0, .damping = 0.0, .max_force = 3.0};
    const auto force = [&](const Vec3& p) {
        const guide::RoundedContact wall = guide::rounded_inside_of(p, half);
        return wall.share * law.repel(wall.depth, wall.normal, {});
    };
    const Random random{11};
    double steepest = 0.0;
    for (std::uint64_t n = 0; n < 20'000; ++n) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = half[axis] * (2.0 * random.uniform(3 * n + static_cast<std::uint64_t>(axis)) - 1.0);
        // Half of them near the planes where two faces are as near.
        if (n % 2 == 1) p[static_cast<int>(n / 2 % 3)] *= 1e-3;
        const Vec3 q = p + some_vector(n, 1e-6);
        if (guide::inside_of(q, half).depth == 0.0) continue;
        steepest = std::max(steepest, glm::distance(force(p), force(q)) / glm::distance(p, q));
        CHECK(glm::length(force(p)) <= 3.0 * (1.0 + 1e-12));
    }
    CHECK(steepest < 3.6 * 500.0);
    CHECK(steepest > 500.0);
    // Close to a face it is the wall of that face.
    CHECK(force({0.0, 0.0, 0.019}).z == Approx(0.5).epsilon(1e-4));
    CHECK(force({0.0, 0.0281, 0.012}).y == Approx(0.95).epsilon(0.01));
    // A closed way through all of it gives nothing back.
    const auto at = [&](double t) {
        const double w = 2.0 * std::numbers::pi * t;
        return Vec3(0.045 * std::sin(w), 0.028 * std::sin(2.0 * w + 0.4), 0.019 * std::cos(3.0 * w));
    };
    double work = 0.0, moved = 0.0;
    constexpr int steps = 100'000;
    for (int k = 0; k < steps; ++k) {
        const Vec3 from = at(1.0 * k / steps), to = at((k + 1.0) / steps);
        const double given = glm::dot(0.5 * (force(from) + force(to)), to - from);
        work += given;
        moved += std::abs(given);
    }
    CHECK(moved > 0.1);
    CHECK(std::abs(work) < 1e-6 * moved);
}

TEST_CASE("a pull goes over to another place in 50 ms, and takes energy from the hand meanwhile, whatever it does") {
    constexpr double dt = 1e-3;
    const guide::GuideLaw law{.stiffness = 200.0, .damping = 0.0, .max_force = 3.0, .reach = 0.0};
    // Two parallel lines 20 mm apart.
    const guide::Path path(std::vector<Vec3>{{-0.1, 0.01, 0}, {0.1, 0.01, 0}, {0.1, -0.01, 0}, {-0.1, -0.01, 0}}, false,
                           false);
    guide::TurningPull pull;
    const auto on = [&](const Vec3& p) {
        const guide::Path::Place place = path.nearest(p);
        return pull.on(law, p, {}, place.point, place.tangent, dt);
    };
    Vec3 before = on({0.0, 0.005, 0.0});
    CHECK(before.y == Approx(1.0));
    double most = 0.0;
    for (int k = 1; k <= 110; ++k) {
        const Vec3 now = on({0.0, 0.005 - 1e-4 * std::min(k, 100), 0.0});
        most = std::max(most, glm::distance(now, before));
        before = now;
    }
    CHECK(before.y == Approx(-1.0));
    CHECK(most < 4.0 * dt / guide::TurningPull::turn_s + 200.0 * 2e-4);

    // A hand that crosses to and fro at random: the work is no more than sampling explains.
    pull.reset();
    const Random random{5};
    Vec3 p(0.0, 0.01, 0.0), v(0.0), acting = on(p);
    double work = 0.0, explained = 0.0;
    const auto potential = [&](const Vec3& at) {
        return 0.5 * 200.0 * std::pow(glm::distance(path.nearest(at).point, at), 2.0);
    };
    for (std::uint64_t n = 0; n < 100'000; ++n) {
        const Vec3 push(random.normal(3 * n), random.normal(3 * n + 1), random.normal(3 * n + 2));
        v = 0.97 * v + 0.02 * push;
        const Vec3 step = v * dt;
        if (std::abs(p.x + step.x) > 0.05) v.x = -v.x;
        if (std::abs(p.y + step.y) > 0.015) v.y = -v.y;
        if (std::abs(p.z + step.z) > 0.005) v.z = -v.z;
        const Vec3 moved = v * dt;
        work += glm::dot(acting, moved);
        explained += 0.5 * 200.0 * glm::dot(moved, moved);
        p += moved;
        acting = on(p);
        if (n % 1000 == 0) CHECK(work <= explained - potential(p) + 1e-3);
    }
    CHECK(work < 0.0);
}

TEST_CASE("rounding does not send a hand to and fro between two places that are as near") {
    constexpr double dt = 1e-4;
    const guide::GuideLaw law{.stiffness = 20e3, .damping = 0.0, .max_force = 50.0, .reach = 0.0};
    const guide::Path path(std::vector<Vec3>{{-0.1, 2e-3, 0}, {0.1, 2e-3, 0}, {0.1, -2e-3, 0}, {-0.1, -2e-3, 0}}, false,
                           false);
    guide::TurningPull pull;
    double most = 0.0;
    Vec3 before(0.0);
    for (int k = 0; k < 2000; ++k) {
        const Vec3 p(2e-6 * k, k % 2 == 0 ? 1e-12 : -1e-12, 0.0);
        const guide::Path::Place place = path.nearest(p);
        const Vec3 now = pull.on(law, p, {}, place.point, place.tangent, dt);
        if (k > 0) most = std::max(most, glm::distance(now, before));
        before = now;
    }
    CHECK(most < 80.0 * dt / guide::TurningPull::turn_s + 0.1);
}

TEST_CASE("a pull does not jump between places that are near each other") {
    constexpr double dt = 1e-3, stiffness = 20e3;
    const guide::GuideLaw law{.stiffness = stiffness, .damping = 0.0, .max_force = 50.0, .reach = 0.0};
    // Across the bisector of a bend, near its corner: the two nearest places are 5 to 90 µm apart.
    const guide::Path path(std::vector<Vec3>{{-0.02, 0.0, 5e-3}, {0.0, 0.0, 0.0}, {0.02, 0.0, 5e-3}}, false, false);
    for (const double z : {1e-5, 5e-5, 2e-4}) {
        guide::TurningPull pull;
        double most = 0.0;
        Vec3 before(0.0);
        for (int k = 0; k < 400; ++k) {
            const Vec3 p(1e-9 * (k - 200), 0.0, z);
            const guide::Path::Place place = path.nearest(p);
            const Vec3 now = pull.on(law, p, {}, place.point, place.tangent, dt);
            if (k > 0) most = std::max(most, glm::distance(now, before));
            before = now;
        }
        CAPTURE(z, most);
        CHECK(most <
              1.1 * stiffness * guide::TurningPull::still + 2.0 * stiffness * z * dt / guide::TurningPull::turn_s);
    }
}

TEST_CASE("damping turns with a path, and only takes") {
    const guide::GuideLaw law{.stiffness = 0.0, .damping = 10.0, .max_force = 50.0, .reach = 0.0};
    guide::TurningPull pull;
    const Vec3 along(1.0, 0.0, 0.0), v(0.3, 0.0, 0.0);
    Vec3 before = pull.on(law, {}, v, {}, along, 1e-3);
    CHECK(glm::length(before) == 0.0);
    // The path bends by a right angle.
    for (int k = 0; k < 100; ++k) {
        const Vec3 now = pull.on(law, {}, v, {}, {0.0, 1.0, 0.0}, 1e-3);
        CHECK(glm::distance(now, before) < 0.3);
        CHECK(glm::dot(now, v) <= 0.0);
        before = now;
    }
    CHECK(before.x == Approx(-3.0).epsilon(1e-3));
    for (std::uint64_t n = 0; n < 1000; ++n) {
        const Vec3 w = some_vector(2 * n), tangent = glm::normalize(some_vector(2 * n + 1));
        CHECK(glm::dot(pull.on(law, {}, w, {}, tangent, 1e-3), w) <= 1e-12);
    }
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
