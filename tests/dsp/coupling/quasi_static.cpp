// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/quasi_static.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/coupling/dynamic_coupling.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/dsp/coupling/held.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

using namespace tactus;
using test::Held;

namespace {

const contact::Voxmap& ball_map() {
    static const contact::Voxmap map = test::map_of(contact::Ball{25.0 * mm}, 0.35 * mm);
    return map;
}
const contact::Pointshell& small_box() {
    static const contact::Pointshell shell = test::shell_of(contact::Box{{8.0 * mm, 6.0 * mm, 5.0 * mm}}, 0.8 * mm);
    return shell;
}

/// The hand wanders about a place where the box is pressed into the ball: a few mm and degrees, up to 3 Hz.
Pose wandering(double t, double depth) {
    const double w = 2.0 * std::numbers::pi;
    const Vec3 at(4.0 * mm * std::sin(0.7 * w * t) + 0.6 * mm * std::sin(2.9 * w * t),
                  3.0 * mm * std::sin(0.9 * w * t + 1.0), 27.5 * mm - depth + 1.5 * mm * std::sin(1.3 * w * t + 2.0));
    const Vec3 turn(0.12 * std::sin(1.1 * w * t), 0.15 * std::sin(0.8 * w * t + 0.5), 0.2 * std::sin(0.6 * w * t));
    return {at, rotation_by(turn)};
}

}  // namespace

TEST_CASE("a symmetric system is solved, and a singular one moves nothing that no spring holds") {
    const Random random{7};
    for (std::uint64_t n = 0; n < 200; ++n) {
        geometry::Matrix6 k{};
        geometry::Vector6 x{}, b{}, found{};
        for (std::uint64_t r = 0; r < 9; ++r)
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j)
                    k[6 * i + j] += random.normal(1000 * n + 10 * r + i) * random.normal(1000 * n + 10 * r + j);
        for (std::size_t i = 0; i < 6; ++i) x[i] = random.normal(1000 * n + 500 + i);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) b[i] += k[6 * i + j] * x[j];
        REQUIRE(geometry::solve_symmetric6(k, b, found));
        for (std::size_t i = 0; i < 6; ++i) CHECK(found[i] == Approx(x[i]).margin(1e-4));
    }
    geometry::Matrix6 one{};
    one[0] = 1e3;
    geometry::Vector6 x{};
    REQUIRE(geometry::solve_symmetric6(one, {5.0, 0, 0, 0, 0, 0}, x));
    CHECK(x[0] == Approx(5e-3));
    for (std::size_t i = 1; i < 6; ++i) CHECK(x[i] == 0.0);
    one[7] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(geometry::solve_symmetric6(one, {5.0, 0, 0, 0, 0, 0}, x));
    CHECK(x == geometry::Vector6{});
}

TEST_CASE("a spring's force is the derivative of its energy, and stays at its limit") {
    const coupling::SaturatedSpring spring{1000.0, 3.0};
    for (const double length : {0.5 * mm, 2.999 * mm, 3.001 * mm, 20.0 * mm}) {
        const Vec3 u = length * glm::normalize(Vec3(1, -2, 2)), h(0, 0, 1e-9);
        const double slope = (spring(u + h).energy - spring(u - h).energy) / 2e-9;
        CHECK(slope == Approx(spring(u).force.z).epsilon(1e-6));
        CHECK(glm::length(spring(u).force) <= 3.0 + 1e-12);
    }
    CHECK(glm::length(spring(Vec3(0, 0, 1.0)).force) == Approx(3.0));
}

TEST_CASE("energy never rises, and a balanced hand feels the sum of the contact forces") {
    Held held(small_box(), {&ball_map()});
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, wandering(0.0, -5.0 * mm));
    int balanced = 0, pressed = 0;
    for (int n = 0; n < 4000; ++n) {
        const Pose hand = wandering(n * 1e-3, std::min(3.0 * mm, -5.0 * mm + n * 0.02 * mm));
        const coupling::QuasiStaticState& now = coupling.update(hand, held);
        REQUIRE(now.energy <= now.energy_before);
        REQUIRE(now.iterations <= 10);
        REQUIRE(now.evaluations <= 24);
        if (now.contact.in_contact > 0) ++pressed;
        if (!now.balanced) continue;
        ++balanced;
        const Wrench contact = now.contact.wrench();
        CHECK(glm::length(now.wrench.force - contact.force) <= 1e-3);
        CHECK(glm::length(now.wrench.torque - contact.torque) <= 1e-3 * coupling.settings.gyration);
    }
    CHECK(pressed > 2500);
    CHECK(balanced > 3800);
}

TEST_CASE("the hand's pose of a tick acts in the force of that tick") {
    Held held(small_box(), {&ball_map()});
    const Pose start{{0.0, 0.0, 27.4 * mm}, {1, 0, 0, 0}};
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, start);
    for (int n = 0; n < 20; ++n) coupling.update(start, held);
    const double before = coupling.state().wrench.force.z;
    const Pose lower{{0.0, 0.0, 27.3 * mm}, {1, 0, 0, 0}};
    const double after = coupling.update(lower, held).wrench.force.z;
    CHECK(after - before > 0.08);
}

TEST_CASE("a held pose is silent") {
    Held held(small_box(), {&ball_map()});
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, wandering(0.0, -5.0 * mm));
    for (const double at : {0.31, 0.77, 1.9}) {
        const Pose hand = wandering(at, 2.5 * mm);
        for (int n = 0; n < 100; ++n) coupling.update(hand, held);
        const Wrench first = coupling.state().wrench;
        REQUIRE(glm::length(first.force) > 0.5);
        for (int n = 0; n < 10000; ++n) {
            const Wrench now = coupling.update(hand, held).wrench;
            REQUIRE(glm::length(now.force - first.force) < 1e-6);
        }
    }
}

TEST_CASE("free of everything the proxy is at the hand, however fast that goes") {
    Held held(small_box(), {&ball_map()});
    held.free = 3.0 * mm;
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, {{0, 0, 80.0 * mm}, {1, 0, 0, 0}});
    for (int n = 0; n < 50; ++n) {
        const Pose hand{{2.0 * mm * n, 0.0, 80.0 * mm}, rotation_by({0.0, 0.01 * n, 0.0})};
        const coupling::QuasiStaticState& now = coupling.update(hand, held);
        CHECK(glm::length(now.wrench.force) < 1e-3);
        CHECK(glm::length(now.wrench.torque) < 1e-4);
    }
}

TEST_CASE("a pose that is none, a jump and half a turn leave the proxy on its side") {
    Held held(small_box(), {&ball_map()});
    const Pose pressed{{0.0, 0.0, 26.0 * mm}, {1, 0, 0, 0}};
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, {{0, 0, 30.0 * mm}, {1, 0, 0, 0}});
    for (int n = 0; n < 50; ++n) coupling.update(pressed, held);
    const Wrench good = coupling.state().wrench;
    REQUIRE(good.force.z > 0.5);

    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const Pose& bad : {Pose{{nan, 0, 0}, {1, 0, 0, 0}}, Pose{{0, inf, 0}, {1, 0, 0, 0}},
                            Pose{{0, 0, 0}, {nan, 0, 0, 0}}, Pose{{0, 0, 0}, {0, 0, 0, 0}}}) {
        const coupling::QuasiStaticState& now = coupling.update(bad, held);
        CHECK_FALSE(now.hand_is_valid);
        CHECK(glm::length(now.wrench.force - good.force) < 2e-3);
    }
    // 15 mm and 14 degrees at once, into the ball, held: pushed out to the side it came from.
    const Pose deep{{0.0, 0.0, 11.0 * mm}, rotation_by({0.25, 0.0, 0.0})};
    for (int n = 0; n < 60; ++n) coupling.update(deep, held);
    CHECK(coupling.state().proxy.position.z > 26.0 * mm);
    CHECK(coupling.state().balanced);
    CHECK(coupling.state().wrench.force.z > 10.0);
    // Half a turn: the torque stays within its limit and nothing blows up.
    const Pose flipped{{0.0, 0.0, 26.0 * mm}, rotation_by({std::numbers::pi, 0.0, 0.0})};
    for (int n = 0; n < 200; ++n) {
        const coupling::QuasiStaticState& now = coupling.update(flipped, held);
        REQUIRE(is_finite(now.wrench));
        REQUIRE(glm::length(now.wrench.torque) <= coupling.settings.springs.angular.limit + 1e-9);
    }
    // The device goes back and everything is as before.
    for (int n = 0; n < 400; ++n) coupling.update(pressed, held);
    CHECK(glm::length(coupling.state().wrench.force - good.force) < 0.02);
}

TEST_CASE("a turn past half way round is still pulled back the way it came") {
    const Vec3 before(0.0, 0.0, 3.0);
    const Vec3 now = coupling::rotation_near({1, 0, 0, 0}, rotation_by({0.0, 0.0, 3.3}), before);
    CHECK(now.z == Approx(3.3));
    CHECK(coupling::rotation_near({1, 0, 0, 0}, rotation_by({0.0, 0.0, 0.4}), before).z == Approx(0.4));
}

TEST_CASE("bodies and springs at the edge of sense give finite forces") {
    const contact::Pointshell none = contact::make_pointshell({});
    const contact::Pointshell one =
        contact::make_pointshell(std::vector<contact::SurfacePoint>{{Vec3(0.0), Vec3(0, 0, -1), 1e-6, 0}});
    const contact::Pointshell inside = test::shell_of(contact::Ball{3.0 * mm}, 1.0 * mm);
    const contact::Pointshell same = test::shell_of(contact::Ball{25.0 * mm}, 2.0 * mm);
    const contact::Voxmap flat =
        contact::sample_voxmap(contact::centred_layout(21, 1.0 * mm), [](const Vec3&) { return -1.0 * mm; });
    const auto run = [](const contact::Pointshell& shell, const contact::Voxmap& map, const Pose& hand, auto&& change) {
        Held held(shell, {&map});
        coupling::QuasiStaticCoupling coupling = test::coupling_for(held, hand);
        change(coupling, held);
        for (int n = 0; n < 200; ++n) {
            const coupling::QuasiStaticState& now = coupling.update(hand, held);
            REQUIRE(is_finite(now.wrench));
            REQUIRE(is_valid(now.proxy));
            REQUIRE(now.energy <= now.energy_before);
        }
        return coupling.state();
    };
    const auto as_is = [](auto&, auto&) {};
    const Pose top{{0.0, 0.0, 24.0 * mm}, {1, 0, 0, 0}}, centre{};
    CHECK(run(none, ball_map(), top, as_is).wrench.force == Vec3(0.0));
    CHECK(run(one, ball_map(), top, as_is).wrench.force.z == Approx(0.909).margin(0.05));
    run(inside, ball_map(), centre, as_is);
    run(same, ball_map(), centre, as_is);
    // No gradient anywhere: energy, but no force.
    CHECK(run(inside, flat, centre, as_is).wrench.force == Vec3(0.0));
    // On the very border of the grid.
    run(one, flat, {{10.0 * mm, 0.0, 0.0}, {1, 0, 0, 0}}, as_is);
    for (const double k : {0.0, 1e9})
        for (const double k_r : {0.0, 1e4}) {
            run(small_box(), ball_map(), {{0.0, 0.0, 26.0 * mm}, {1, 0, 0, 0}}, [&](auto& coupling, auto& held) {
                coupling.settings.springs = {{k, 20.0}, {k_r, 2.0}};
                held.law.stiffness = k > 0.0 ? 1e9 : 1e4;
            });
        }
    // A scene that has become no scene gives no force.
    struct Broken {
        contact::ContactSum operator()(const Pose&, contact::ContactParts) {
            contact::ContactSum sum;
            sum.energy = std::numeric_limits<double>::quiet_NaN();
            return sum;
        }
        double clearance(const Pose&) const { return 0.0; }
    } broken;
    coupling::QuasiStaticCoupling coupling;
    CHECK(coupling.update({{1.0 * mm, 0.0, 0.0}, {1, 0, 0, 0}}, broken).wrench.force == Vec3(0.0));
}

TEST_CASE("sliding over a plane at any slope: the force is the spring's along the normal") {
    const contact::Pointshell foot = contact::make_pointshell(bodies::foot_points(5, 4.0 * mm));
    const Vec3 normal = glm::normalize(Vec3(0.3, -0.2, 1.0)), along = glm::normalize(glm::cross(normal, Vec3(0, 1, 0)));
    const contact::Voxmap plane = contact::sample_voxmap(contact::centred_layout(81, 0.35 * mm),
                                                         [&](const Vec3& p) { return glm::dot(p, normal); });
    const Quat flat = glm::angleAxis(std::acos(normal.z), glm::normalize(glm::cross(Vec3(0, 0, 1), normal)));
    Held held(foot, {&plane});
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, {normal * mm, flat});
    for (int n = 0; n < 800; ++n) {
        const double deep = std::min(2.0 * mm, 0.01 * mm * n);
        const Wrench felt = coupling.update({along * (0.01 * mm * n) - normal * deep, flat}, held).wrench;
        if (n < 300) continue;
        const double expected = 2.0 * mm * 1000.0 * 250.0 / 251.0;  // 25 points of 10 N/mm in series, blend apart
        REQUIRE(glm::length(felt.force) == Approx(expected).epsilon(0.01));
        REQUIRE(glm::length(felt.force / glm::length(felt.force) - normal) < 0.001);
        REQUIRE(glm::length(felt.torque) < 1e-4);
    }
}

TEST_CASE("sliding over a ball: the force is the spring's along the normal") {
    const contact::Pointshell tip =
        contact::make_pointshell(std::vector<contact::SurfacePoint>{{Vec3(0.0), Vec3(0, 0, -1), 1e-6, 0}});
    const double radius = 25.0 * mm, depth = 2.0 * mm;
    for (const contact::Interpolation between :
         {contact::Interpolation::trilinear, contact::Interpolation::quadratic}) {
        Held held(tip, {&ball_map()});
        held.law.interpolation = between;
        coupling::QuasiStaticCoupling coupling = test::coupling_for(held, {{0, 0, 26.0 * mm}, {1, 0, 0, 0}});
        coupling.settings.springs.angular.stiffness = 1.0;
        double worst_angle = 0.0, worst_size = 0.0;
        for (int n = 0; n < 1500; ++n) {
            const double a = 1e-3 * n, deep = std::min(depth, 0.01 * mm * n);
            const Vec3 out(std::sin(a) * std::cos(0.7), std::sin(a) * std::sin(0.7), std::cos(a));
            const Wrench felt = coupling.update({out * (radius - deep), {1, 0, 0, 0}}, held).wrench;
            if (n < 300) continue;
            // In series with the contact's 10 N/mm, of which the blend takes nothing at this depth.
            const double expected = depth * 1000.0 * 10.0 / 11.0;
            const double size = glm::length(felt.force);
            worst_angle = std::max(worst_angle, std::acos(std::min(1.0, glm::dot(felt.force / size, out))));
            worst_size = std::max(worst_size, std::abs(size / expected - 1.0));
        }
        CAPTURE(static_cast<int>(between), worst_size, worst_angle);
        // At 71 voxels of radius. The gradient of the trilinear interpolant lags by up to half a voxel along each axis.
        CHECK(worst_angle < (between == contact::Interpolation::quadratic ? 0.05 : 0.6) * degree);
        CHECK(worst_size < 0.01);
    }
}

TEST_CASE("the solver allocates nothing") {
    Held held(small_box(), {&ball_map()});
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, wandering(0.0, -5.0 * mm));
    coupling::DynamicCoupling dynamic;
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 100; ++n) {
            coupling.update(wandering(0.01 * n, 2.0 * mm), held);
            dynamic.update(wandering(0.01 * n, 2.0 * mm), {}, 1e-3, held);
        }
    });
    CHECK(seen.none());
}

TEST_CASE("a body with mass swings in at the hand, stands on a ball, and the hand feels the contact") {
    Held held(small_box(), {&ball_map()});
    coupling::DynamicCoupling coupling;
    coupling.settings.reach = small_box().reach;
    coupling.settings.springs = {{1000.0, 40.0}, {1.0, 4.0}};
    coupling.reset({{0, 0, 30.0 * mm}, {1, 0, 0, 0}});
    const Pose pressed{{0.0, 0.0, 25.0 * mm}, {1, 0, 0, 0}};
    for (int n = 0; n < 3000; ++n) coupling.update(pressed, {}, 1e-3, held);
    const coupling::DynamicState& now = coupling.state();
    CHECK(glm::length(now.twist.linear) < 1e-5);
    CHECK(now.wrench.force.z > 1.5);
    CHECK(glm::length(now.wrench.force - now.contact.wrench().force) < 1e-2);
    // Without contact the force dies away, whatever the stiffness.
    coupling.settings.springs.linear.stiffness = 1e6;
    for (int n = 0; n < 3000; ++n) coupling.update({{0, 0, 60.0 * mm}, {1, 0, 0, 0}}, {}, 1e-3, held);
    CHECK(glm::length(coupling.state().wrench.force) < 1e-6);
}

TEST_CASE(
    "what was learned of a quadratic balance solves it in one step, and a step that says nothing teaches nothing") {
    const double lever = 0.02;
    geometry::Matrix6 known{}, real{};
    for (std::size_t i = 0; i < 6; ++i) known[7 * i] = real[7 * i] = i < 3 ? 1e3 : 1.0;
    // Curvature under load, of either sign, couples shifts with turns.
    const double bends[2][6] = {{20.0, -8.0, 3.0, 0.3, 0.1, -0.2}, {-5.0, 9.0, 12.0, 0.1, -0.4, 0.2}};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            real[6 * i + j] += bends[0][i] * bends[0][j] - 0.5 * bends[1][i] * bends[1][j];
    coupling::LearnedCurvature learned;
    const geometry::Vector6 steps[2] = {{1e-4, 0.0, 2e-5, 1e-3, 0.0, 0.0}, {0.0, 1e-4, 1e-4, 0.0, -1e-3, 2e-3}};
    for (const geometry::Vector6& s : steps) {
        geometry::Vector6 change{};
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) change[i] += real[6 * i + j] * s[j];
        learned.learn(s, change, known, lever);
    }
    const geometry::Matrix6 sum = learned.added_to(known);
    for (std::size_t i = 0; i < 36; ++i) CHECK(sum[i] == Approx(real[i]).margin(1e-9));

    learned.learn({}, {}, known, lever);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    learned.learn({1e-4, 0, 0, 0, 0, 0}, {nan, 0, 0, 0, 0, 0}, known, lever);
    CHECK(learned.added_to(known) == sum);
    learned.forget();
    CHECK(learned.added_to(known) == known);
}
