// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/hand.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;

namespace {

constexpr double period = 0.001;

const auto stay = [](double, const Wrench&, const Pose&) noexcept { return simulate::Intention{}; };

/// Largest penetration in the last quarter of `seconds` against a wall of `stiffness` that is sampled and held every
/// millisecond with `delay` further ticks; the hand is a mass and a damper and starts 1 mm inside, pushed by 1 N.
double swing_against_wall(double stiffness, double damping, int delay, double seconds) {
    simulate::Hand hand;
    hand.dynamics = {
        .mass = 0.2, .stiffness = 0.0, .damping = damping, .angular_stiffness = 0.0, .angular_damping = 0.0};
    const double rest = -1.0 / stiffness;
    hand.pose.position.z = rest - 1e-4;
    double held[4] = {};
    for (double& force : held) force = 1.0;
    double largest = 0.0;
    const int ticks = static_cast<int>(seconds / period);
    for (int i = 0; i < ticks; ++i) {
        for (int k = 3; k > 0; --k) held[k] = held[k - 1];
        held[0] = -stiffness * hand.pose.position.z;  // bilateral: contact loss would hide a growing swing
        simulate::advance(hand, stay, Wrench{{0.0, 0.0, held[delay] - 1.0}, {}}, period);
        if (i > ticks * 3 / 4) largest = std::max(largest, std::abs(hand.pose.position.z - rest));
    }
    return largest;
}

}  // namespace

TEST_CASE("a sampled wall is stable below b / (T (1/2 + D)) and unstable above") {
    for (int delay : {0, 1, 2}) {
        const double damping = 2.0;
        const double bound = damping / (period * (0.5 + delay));
        INFO("delay " << delay << ", bound " << bound << " N/m");
        CHECK(swing_against_wall(0.7 * bound, damping, delay, 4.0) < 1e-5);
        CHECK(swing_against_wall(1.3 * bound, damping, delay, 4.0) > 1e-3);
    }
}

TEST_CASE("an undamped hand on its spring keeps its energy") {
    simulate::Hand hand;
    hand.dynamics = {.mass = 0.2, .damping = 0.0, .angular_damping = 0.0};
    hand.pose.position.x = 5e-3;
    const auto energy = [&] {
        return 0.5 * 0.2 * glm::dot(hand.twist.linear, hand.twist.linear) +
               0.5 * 800.0 * glm::dot(hand.pose.position, hand.pose.position);
    };
    const double before = energy();
    simulate::advance(hand, stay, {}, 5.0);
    CHECK(energy() == Approx(before).epsilon(1e-9));
}

TEST_CASE("a damped hand comes to rest where force and spring balance, in translation and rotation") {
    simulate::Hand hand;
    simulate::advance(hand, stay, Wrench{{4.0, 0.0, -2.0}, {0.0, 0.2, 0.0}}, 3.0);
    CHECK(hand.pose.position.x == Approx(4.0 / 800.0));
    CHECK(hand.pose.position.z == Approx(-2.0 / 800.0));
    const Vec3 turned = rotation_between({1.0, 0.0, 0.0, 0.0}, hand.pose.orientation);
    CHECK(turned.y == Approx(0.1));
    CHECK(glm::length(hand.twist.linear) < 1e-9);
    CHECK(glm::length(hand.twist.angular) < 1e-9);
}

TEST_CASE("the hand's twist is the derivative of its pose") {
    simulate::Hand hand;
    const Wrench force{{3.0, 1.0, -2.0}, {0.05, 0.0, -0.02}};
    simulate::advance(hand, stay, force, 0.02);
    simulate::Hand before = hand, after = hand;
    before.step(-1e-6, simulate::Intention{}, force);
    after.step(1e-6, simulate::Intention{}, force);
    const Vec3 linear = (after.pose.position - before.pose.position) / 2e-6;
    const Vec3 angular = rotation_between(before.pose.orientation, after.pose.orientation) / 2e-6;
    CHECK(glm::length(linear - hand.twist.linear) < 1e-6);
    CHECK(glm::length(angular - hand.twist.angular) < 1e-5);
}

TEST_CASE("a skipped tick is caught up: 5 ms at once ends where five times 1 ms does") {
    simulate::Hand once, often;
    const Wrench force{{3.0, 0.0, -2.0}, {0.1, 0.0, 0.0}};
    simulate::advance(once, stay, force, 5 * period);
    for (int i = 0; i < 5; ++i) simulate::advance(often, stay, force, period);
    CHECK(glm::length(once.pose.position - often.pose.position) < 1e-12);
    CHECK(glm::length(rotation_between(once.pose.orientation, often.pose.orientation)) < 1e-12);
    CHECK(glm::length(once.pose.position) > 1e-4);
}

TEST_CASE("a force that is not finite leaves the hand as if there were none") {
    simulate::Hand hand, untouched;
    hand.pose.position.x = untouched.pose.position.x = 1e-3;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    simulate::advance(hand, stay, Wrench{{nan, 0.0, 0.0}, {0.0, 0.0, std::numeric_limits<double>::infinity()}}, 0.01);
    simulate::advance(untouched, stay, Wrench{}, 0.01);
    CHECK(hand.pose.position == untouched.pose.position);
    CHECK(is_valid(hand.pose));
}

TEST_CASE("a rotation is recovered from its rotation vector, small or large") {
    const Quat from = rotation_by({0.3, -0.2, 0.9});
    for (const Vec3& theta : {Vec3(1e-12, 0.0, 0.0), Vec3(0.0, 1e-4, 0.0), Vec3(0.5, -1.0, 2.0), Vec3(0.0, 0.0, 3.1)}) {
        const Vec3 back = rotation_between(from, rotation_by(theta) * from);
        CHECK(glm::length(back - theta) <= 1e-12 + 1e-9 * glm::length(theta));
    }
}
