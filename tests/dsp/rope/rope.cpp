// SPDX-License-Identifier: Apache-2.0
// A rope against strings, beams and belts with known solutions.
#include "dsp/rope/rope.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/rope/measure.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;
using namespace tactus::rope;

namespace {

constexpr double tick = 1e-3;

// A line of equal rest lengths.
Rope rope_along(const std::vector<Vec3>& line, std::size_t points, double rest_length, const RopeMaterial& material,
                const RopeSettings& settings = {}) {
    return {resampled(line, points), std::vector<double>(points - 1, rest_length / static_cast<double>(points - 1)),
            material, settings};
}

double settle(Rope& rope, const Obstacle* bone = nullptr, int steps = 60, double h = 1.0) {
    RopeStep last;
    for (int n = 0; n < steps; ++n) last = rope.step(h, bone);
    return last.residual;
}

}  // namespace

TEST_CASE("a hanging string stretches by its own weight as theory says") {
    for (const std::size_t points : {17u, 33u, 65u}) {
        RopeMaterial material;
        material.stiffness = 2.0;
        material.weight = 2.0;  // 5 % of mean strain over 100 mm
        Rope rope = rope_along({Vec3(0.0), Vec3(0.0, 0.0, -0.1)}, points, 0.1, material);
        rope.hold(0, Vec3(0.0));
        settle(rope);
        const double wanted = material.weight * 0.1 * 0.1 / (2.0 * material.stiffness);
        CHECK(-rope.points().back().z - 0.1 == Approx(wanted).epsilon(1e-3));
        CHECK(rope.pull_on(0).z == Approx(-material.weight * 0.1).epsilon(1e-3));
        CHECK(rope.tension(0) == Approx(material.weight * 0.1).epsilon(1.0 / static_cast<double>(points)));
    }
}

TEST_CASE("a straight pull gives the force of the law at every strain") {
    RopeMaterial material;
    material.stiffness = 2.0;
    Rope rope = rope_along({Vec3(0.0), Vec3(0.1, 0.0, 0.0)}, 65, 0.1, material);
    rope.hold(0, Vec3(0.0));
    for (double strain = 0.05; strain < 0.301; strain += 0.05) {
        rope.hold(64, Vec3(0.1 * (1.0 + strain), 0.0, 0.0));
        for (int n = 0; n < 400; ++n) rope.step(tick, nullptr);
        CHECK(-rope.pull_on(64).x == Approx(2.0 * strain).epsilon(1e-3));
        CHECK(rope.pull_on(0).x == Approx(2.0 * strain).epsilon(1e-3));
    }
}

TEST_CASE("a belt over a cylinder loses tension as Euler and Eytelwein say", "[slow]") {
    const double radius = 10.0 * mm;
    const Cylinder drum(Vec3(0.0), Vec3(0.0, 1.0, 0.0), radius);
    for (const double friction : {0.0, 0.1, 0.3})
        for (const double wrap : {90.0, 180.0, 270.0, 360.0}) {
            CAPTURE(friction, wrap);
            // Round the drum from angle 0 to `wrap`, with straight ends of 20 mm along the tangents.
            std::vector<Vec3> line;
            const double end = wrap * degree;
            const auto on = [&](double a) { return radius * Vec3(std::cos(a), 0.0, std::sin(a)); };
            const auto tangent = [&](double a) { return Vec3(-std::sin(a), 0.0, std::cos(a)); };
            line.push_back(on(0.0) - 20.0 * mm * tangent(0.0));
            for (int n = 0; n <= 200; ++n) line.push_back(on(end * n / 200.0));
            line.push_back(on(end) + 20.0 * mm * tangent(end));
            RopeMaterial material;
            material.stiffness = 20.0;
            material.friction = friction;
            material.drag = 1e-4;
            const std::size_t points = 65;
            Rope rope = rope_along(line, points, length_of(line), material);
            // A weight of 0.1 N on one end; the other is pulled at 5 mm/s.
            rope.load(0, -0.1 * tangent(0.0));
            double residual = 0.0;
            for (int n = 0; n < 600; ++n) {
                rope.hold(points - 1, line.back() + tangent(end) * (n * 5e-6));
                const RopeStep seen = rope.step(tick, &drum);
                if (n > 300) residual = std::max(residual, seen.residual);
            }
            CHECK(residual < 1e-4);
            const double wanted = 0.1 * std::exp(friction * end);
            CHECK(glm::length(rope.pull_on(points - 1)) == Approx(wanted).epsilon(0.01));
        }
}

TEST_CASE("a belt over a cylinder holds still below the limit of friction and does not creep") {
    const double radius = 10.0 * mm;
    const Cylinder drum(Vec3(0.0), Vec3(0.0, 1.0, 0.0), radius);
    RopeMaterial material;
    material.stiffness = 20.0;
    material.friction = 0.3;
    std::vector<Vec3> line{Vec3(-radius, 0.0, -20.0 * mm)};
    for (int n = 0; n <= 100; ++n) {
        const double a = std::numbers::pi * (1.0 - n / 100.0);
        line.push_back(radius * Vec3(std::cos(a), 0.0, std::sin(a)));
    }
    line.emplace_back(radius, 0.0, -20.0 * mm);
    Rope rope = rope_along(line, 65, length_of(line), material);
    // Taut first, so that friction is there when the loads are: 0.1 and 0.15 N, less than exp(0.3 π) = 2.57 apart.
    rope.hold(0, line.front() - Vec3(0.0, 0.0, 0.3 * mm));
    rope.hold(64, line.back() - Vec3(0.0, 0.0, 0.3 * mm));
    for (int n = 0; n < 200; ++n) rope.step(tick, &drum);
    rope.release(0);
    rope.release(64);
    rope.load(0, Vec3(0.0, 0.0, -0.1));
    rope.load(64, Vec3(0.0, 0.0, -0.15));
    for (int n = 0; n < 1000; ++n) rope.step(tick, &drum);
    const Vec3 before = rope.points()[32];
    for (int n = 0; n < 2000; ++n) rope.step(tick, &drum);
    CHECK(glm::length(rope.points()[32] - before) < 1e-7);
    CHECK(rope.tension(0) == Approx(0.1).epsilon(0.01));
    CHECK(rope.tension(63) == Approx(0.15).epsilon(0.01));
}

TEST_CASE("a rope that is longer than the way hangs as a catenary") {
    for (const std::size_t points : {33u, 65u, 129u}) {
        RopeMaterial material;
        material.stiffness = 1e4;
        material.weight = 1.0;
        std::vector<Vec3> line{Vec3(0.0), Vec3(0.05, 0.0, -0.03), Vec3(0.1, 0.0, 0.0)};
        Rope rope = rope_along(line, points, 0.12, material);
        rope.hold(0, Vec3(0.0));
        rope.hold(points - 1, Vec3(0.1, 0.0, 0.0));
        settle(rope, nullptr, 300);
        // 2 a sinh(span / 2a) = length.
        double low = 0.01, high = 1.0;
        for (int n = 0; n < 100; ++n) {
            const double a = 0.5 * (low + high);
            (2.0 * a * std::sinh(0.05 / a) > 0.12 ? low : high) = a;
        }
        const double sag = low * (std::cosh(0.05 / low) - 1.0);
        double lowest = 0.0;
        for (const Vec3& p : rope.points()) lowest = std::min(lowest, p.z);
        CHECK(-lowest == Approx(sag).epsilon(0.01));
        CHECK(glm::length(rope.pull_on(0)) == Approx(std::hypot(low, 0.06) * material.weight).epsilon(0.01));
    }
}

TEST_CASE("a clamped rope bends under a load at its tip as a beam") {
    for (const std::size_t points : {21u, 41u, 65u}) {
        RopeMaterial material;
        material.stiffness = 50.0;
        material.bending = 1e-5;
        RopeSettings exact;
        exact.tolerance = 1e-9;
        Rope rope = rope_along({Vec3(0.0), Vec3(0.1, 0.0, 0.0)}, points, 0.1, material, exact);
        rope.hold(0, Vec3(0.0));
        rope.clamp_first(Vec3(1.0, 0.0, 0.0));
        const double load = 2.0 * mm * 3.0 * material.bending / (0.1 * 0.1 * 0.1);
        rope.load(points - 1, Vec3(0.0, 0.0, -load));
        settle(rope, nullptr, 200);
        CHECK(-rope.points().back().z == Approx(2.0 * mm).epsilon(0.005));
        CHECK(rope.pull_on(0).z == Approx(-load).epsilon(0.01));
    }
}

TEST_CASE("reach round a cylinder and a ball is the length of the exact geodesic") {
    const double radius = 10.0 * mm, vessel = 1.5 * mm, r = radius + vessel;
    for (const double turn : {40.0, 100.0, 150.0}) {
        CAPTURE(turn);
        const double a = turn * degree;
        const Vec3 from(r, 0.0, 0.0), to(r * std::cos(a), r * std::sin(a), 25.0 * mm);
        const Vec3 outside = 25.0 * mm * Vec3(std::cos(0.5 * a), std::sin(0.5 * a), 0.3);
        const Cylinder bone(Vec3(0.0), Vec3(0.0, 0.0, 1.0), radius);
        const ShortestPath helix = shortest_path(std::vector{from, outside, to}, &bone, vessel);
        CHECK(helix.is_settled);
        CHECK(helix.length == Approx(std::hypot(r * a, 25.0 * mm)).epsilon(0.003));
        const Ball ball(Vec3(0.0), radius);
        const Vec3 there(r * std::cos(a), r * std::sin(a), 0.0);
        const ShortestPath circle = shortest_path(std::vector{from, outside, there}, &ball, vessel);
        CHECK(circle.length == Approx(r * a).epsilon(0.003));
        // From places off the ball: two tangents and an arc.
        const double far = 30.0 * mm, straight = std::sqrt(far * far - r * r), free = std::acos(r / far);
        const Vec3 begin = far * Vec3(1.0, 0.0, 0.0), end = far * Vec3(std::cos(a), std::sin(a), 0.0);
        const bool is_direct = a < 2.0 * free;
        const ShortestPath mixed = shortest_path(std::vector{begin, 2.0 * outside, end}, &ball, vessel);
        CHECK(mixed.length ==
              Approx(is_direct ? glm::length(end - begin) : 2.0 * straight + r * (a - 2.0 * free)).epsilon(0.003));
    }
}

TEST_CASE("the twist of a rope is the turn of its end, whole turns included") {
    const auto half_circle = [](double bend) {
        std::vector<Vec3> line;
        for (int n = 0; n <= 64; ++n) {
            const double a = bend * n / 64.0;
            line.emplace_back(std::sin(a) * 0.03, (1.0 - std::cos(a)) * 0.03, 0.002 * std::sin(3.0 * a));
        }
        return line;
    };
    TwistCount twist;
    double wanted = 0.0;
    for (int n = 0; n <= 360; n += 5) {
        // The end turns about its own direction while the rope bends and the whole moves.
        wanted = n * degree;
        std::vector<Vec3> line = half_circle(1.0 + 1.5 * n / 360.0);
        for (Vec3& p : line) p += Vec3(0.01 * n, 0.0, 0.02 * n) * mm;
        const Vec3 axis = glm::normalize(line.back() - line[line.size() - 2]);
        const Vec3 start = glm::normalize(glm::cross(line[1] - line[0], Vec3(0.0, 1.0, 0.3)));
        const Vec3 level = transported(line, start);
        const Vec3 side = std::cos(wanted) * level + std::sin(wanted) * glm::cross(axis, level);
        CHECK(twist.update(line, start, side) == Approx(wanted).margin(1.0 * degree));
    }
    // In a plane nothing is turned by bending: the normal of the plane is transported to itself.
    std::vector<Vec3> flat;
    for (int n = 0; n <= 30; ++n) flat.emplace_back(0.03 * std::sin(0.1 * n), 0.03 * std::cos(0.1 * n), 0.0);
    CHECK(glm::length(transported(flat, Vec3(0.0, 0.0, 1.0)) - Vec3(0.0, 0.0, 1.0)) < 1e-12);
    CHECK(min_bend_radius(flat) == Approx(30.0 * mm).epsilon(0.002));
}

TEST_CASE("a hand that trembles where a rope gets taut feels no chatter") {
    RopeMaterial material = artery();
    Rope rope = rope_along({Vec3(0.0), Vec3(0.08, 0.0, 0.0)}, 65, 0.08, material);
    rope.hold(0, Vec3(0.0));
    rope.hold(64, Vec3(0.08, 0.0, 0.0));
    settle(rope);
    const Random random{3};
    double least = 1e9, greatest = 0.0;
    for (std::uint64_t n = 0; n < 2000; ++n) {
        rope.hold(64, Vec3(0.08 + 2e-6 * (random.uniform(n) - 0.5), 0.0, 0.0));
        rope.step(tick, nullptr);
        const double force = glm::length(rope.pull_on(64));
        if (n > 500) least = std::min(least, force), greatest = std::max(greatest, force);
    }
    CHECK(greatest - least < 1e-3);
}

TEST_CASE("random pulls on a rope round bone give no energy", "[slow]") {
    // The work of the hand is never less than what is stored; `tactus bench rope` does 100,000 pulls.
    const Ball bone(Vec3(0.0, 0.0, -12.0 * mm), 10.0 * mm);
    double moved = 0.0, worst = 0.0, residual = 0.0;
    int unsolved = 0, ticks = 0;
    for (std::uint64_t pull = 0; pull < 60; ++pull) {
        const Random random{pull + 1};
        RopeMaterial material = artery();
        material.friction = 0.3 * random.uniform(1000);
        Rope rope = rope_along({Vec3(-30.0 * mm, 0.0, 0.0), Vec3(30.0 * mm, 0.0, 0.0)}, 33, 0.06, material);
        rope.hold(0, Vec3(-30.0 * mm, 0.0, 0.0));
        rope.hold(32, Vec3(30.0 * mm, 0.0, 0.0));
        settle(rope, &bone, 5);
        double work = -rope.energy();
        Vec3 goal(30.0 * mm, 0.0, 0.0), hand = goal, velocity(0.0);
        for (std::uint64_t n = 0; n < 200; ++n) {
            if (n % 50 == 0)
                goal = Vec3(20.0 + 30.0 * random.uniform(3 * n), 40.0 * (random.uniform(3 * n + 1) - 0.5),
                            40.0 * (random.uniform(3 * n + 2) - 0.7)) *
                       mm;
            velocity = 0.9 * velocity + 0.1 * 20.0 * (goal - hand);
            hand += tick * velocity;
            rope.hold(32, hand);
            const Vec3 at = rope.points()[32];
            const RopeStep seen = rope.step(tick, &bone);
            residual = std::max(residual, seen.residual);
            unsolved += !seen.is_solved;
            ++ticks;
            const double done = -glm::dot(rope.pull_on(32), rope.points()[32] - at);
            work += done;
            moved += std::abs(done);
            worst = std::min(worst, work - rope.energy());
        }
    }
    CHECK(worst > -1e-6 * moved);
    // The worst tick: the rope slips off the ball.
    CHECK(residual < 0.01);
    CAPTURE(unsolved, ticks);
    CHECK(unsolved < 0.005 * ticks);
}

TEST_CASE("a rope's tick does not allocate and says what it did not solve") {
    const Ball bone(Vec3(0.0, 0.0, -5.0 * mm), 10.0 * mm);
    RopeMaterial material = artery();
    Rope rope = rope_along({Vec3(-30.0 * mm, 0.0, 6.0 * mm), Vec3(30.0 * mm, 0.0, 6.0 * mm)}, 65, 0.05, material);
    rope.hold(0, Vec3(-30.0 * mm, 0.0, 0.0));
    rope.hold(64, Vec3(30.0 * mm, 0.0, 0.0));
    RopeStep seen;
    const RealtimeViolations violations = watch([&] {
        for (int n = 0; n < 20; ++n) seen = rope.step(tick, &bone);
    });
    CHECK(violations.describe() == "none");
    CHECK(seen.contacts > 0);
    // A jump of 1 m: the end follows in steps of half a segment.
    rope.hold(64, Vec3(1.0, 0.0, 0.0));
    const Vec3 before = rope.points()[64];
    seen = rope.step(tick, &bone);
    CHECK(glm::length(rope.points()[64] - before) <= 4.0 * 0.5 * 0.05 / 64.0 + 1e-9);
    CHECK(seen.lag == Approx(glm::length(Vec3(1.0, 0.0, 0.0) - rope.points()[64])));
    RopeSettings lazy;
    lazy.max_iterations = 1;
    Rope rough =
        rope_along({Vec3(-30.0 * mm, 0.0, 6.0 * mm), Vec3(30.0 * mm, 0.0, 6.0 * mm)}, 65, 0.03, material, lazy);
    rough.hold(0, Vec3(-30.0 * mm, 0.0, 0.0));
    const RopeStep one = rough.step(tick, &bone);
    CHECK_FALSE(one.is_solved);
    CHECK(one.residual > 1e-5);
    rough.hold(64, Vec3(std::nan(""), 0.0, 0.0));
    rough.step(tick, &bone);
    CHECK(is_finite(rough.points()[64]));
}

TEST_CASE("a load or a time that is no number moves no rope, and no such step is solved") {
    const RopeMaterial material = artery();
    Rope rope = rope_along({Vec3(0.0), Vec3(0.1, 0.0, 0.0)}, 33, 0.1, material);
    rope.hold(0, Vec3(0.0));
    rope.hold(32, Vec3(0.1, 0.0, 0.0));
    rope.load(16, Vec3(0.0, std::nan(""), 0.0));
    CHECK(rope.step(1e-3, nullptr).is_solved);
    const std::vector<Vec3> before(rope.points().begin(), rope.points().end());
    for (const double h : {0.0, -1e-3, std::nan("")}) {
        CHECK_FALSE(rope.step(h, nullptr).is_solved);
        CHECK(std::ranges::equal(before, rope.points()));
    }
}

TEST_CASE("a bone that does not say where its surface is gives no contact") {
    struct Fog final : Obstacle {
        double distance(const Vec3&, Vec3& normal) const noexcept override {
            normal = Vec3(0.0);
            return 0.5e-3;
        }
    };
    const Fog fog;
    RopeMaterial material = artery();
    material.weight = 0.0;
    Rope rope = rope_along({Vec3(0.0), Vec3(0.1, 0.0, 0.0)}, 33, 0.1, material);
    rope.hold(0, Vec3(0.0));
    rope.hold(32, Vec3(0.1, 0.0, 0.0));
    const RopeStep step = rope.step(1e-3, &fog);
    CHECK(step.is_solved);
    CHECK(step.contacts == 0);
}

TEST_CASE("a rope that rests where two surfaces of bone meet ends its tick when no step makes its energy less") {
    // A groove with walls of 45°: the nearest wall, hence the direction of the force, jumps at its bottom.
    struct Groove final : Obstacle {
        mutable int looks = 0;
        double distance(const Vec3& p, Vec3& normal) const noexcept override {
            ++looks;
            const double side = p.x < 0.0 ? 1.0 : -1.0;
            normal = Vec3(side, 0.0, 1.0) / std::numbers::sqrt2;
            return glm::dot(normal, p);
        }
        double free_way(const Vec3&, double, double) const noexcept override { return 0.0; }
    };
    const Groove groove;
    RopeMaterial material = artery();
    material.weight = 1.0;
    material.friction = 0.0;
    // The tube touches both walls where its middle is √2 radii above their line.
    const double height = std::numbers::sqrt2 * material.radius;
    std::vector<Vec3> line;
    for (int n = 0; n <= 40; ++n) line.emplace_back(n % 2 ? 0.2e-3 : -0.2e-3, 2.5 * mm * n, height + 0.1 * mm);
    Rope rope = rope_along(line, 41, 0.1, material);
    rope.hold(0, line.front());
    rope.hold(40, line.back());
    int most = 0, unsolved = 0;
    double before = std::numeric_limits<double>::infinity();
    for (int n = 0; n < 300; ++n) {
        groove.looks = 0;
        const RopeStep step = rope.step(tick, &groove);
        most = std::max(most, groove.looks);
        unsolved += !step.is_solved;
        // Nothing moves it from outside.
        CHECK(rope.energy() <= before + 1e-12);
        before = rope.energy();
    }
    CAPTURE(most);
    CHECK(unsolved > 0);
    CHECK(most < 150 * 41);
    // It has come to rest, though no point is without force.
    const std::vector<Vec3> rests(rope.points().begin(), rope.points().end());
    for (int n = 0; n < 50; ++n) rope.step(tick, &groove);
    for (std::size_t n = 0; n < rests.size(); ++n) CHECK(glm::length(rope.points()[n] - rests[n]) < 1e-9);
    double lowest = 1.0;
    for (const Vec3& p : rope.points()) lowest = std::min(lowest, p.z);
    CHECK(lowest > height - 0.05 * mm);
}

TEST_CASE("ropes that cannot be are refused") {
    const std::vector<Vec3> two{Vec3(0.0), Vec3(0.1, 0.0, 0.0)}, three{two[0], two[1], Vec3(0.2, 0.0, 0.0)};
    CHECK_THROWS_AS(Rope({}, {}, {}), Error);
    CHECK_THROWS_AS(Rope(two, {0.1}, {}), Error);
    CHECK_THROWS_AS(Rope(three, {0.1}, {}), Error);
    CHECK_THROWS_AS(Rope(three, {0.1, 0.0}, {}), Error);
    RopeMaterial none;
    none.stiffness = 0.0;
    CHECK_THROWS_AS(Rope(three, {0.1, 0.1}, none), Error);
    CHECK_THROWS_AS(shortest_path(std::vector{two[0], two[0]}, nullptr, 0.0), Error);
}

TEST_CASE("an artery that is pulled back to its length in the leg bears the published stress") {
    const RopeMaterial material = artery();
    const double in_situ = 0.1;
    Rope rope = rope_along({Vec3(0.0), Vec3(in_situ, 0.0, 0.0)}, 33, in_situ / 1.12, material);
    CHECK(rope.tension(0) == Approx(62e3 * 3.6e-6).epsilon(1e-9));
    CHECK(1.0 / 1.12 == Approx(free_over_in_situ).margin(0.005));
}
