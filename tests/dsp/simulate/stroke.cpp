// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/stroke.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace tactus;

namespace {

constexpr double servo_period = 0.001;

struct Cut {
    double mean = 0.0, ripple = 0.0, peak = 0.0;  // N, thrust in the last half
    double penetration = 0.0;                     // m at the end, relative to the first surface
    simulate::Hand hand;
    simulate::StrokeOperator intend;
};

/// Presses against a wall 5 mm below the start for `seconds`. The material gives way at `rate` m/s while it is touched.
Cut press(double stiffness, double rate, double seconds, simulate::StrokePlan plan = {}) {
    Cut cut;
    cut.intend = simulate::StrokeOperator(plan);
    cut.hand.pose = plan.start;
    double surface = -5e-3, sum = 0.0, square = 0.0;
    int count = 0;
    Wrench force;
    const int ticks = static_cast<int>(seconds / servo_period);
    for (int i = 0; i < ticks; ++i) {
        simulate::advance(cut.hand, cut.intend, force, servo_period);
        const double inside = surface - cut.hand.pose.position.z;
        force.force.z = inside > 0.0 ? stiffness * inside : 0.0;
        if (inside > 0.0) surface -= rate * servo_period;
        cut.peak = std::max(cut.peak, force.force.z);
        if (i < ticks / 2) continue;
        sum += force.force.z;
        square += force.force.z * force.force.z;
        ++count;
    }
    cut.mean = sum / count;
    cut.ripple = std::sqrt(std::max(square / count - cut.mean * cut.mean, 0.0));
    cut.penetration = -5e-3 - cut.hand.pose.position.z;
    return cut;
}

}  // namespace

TEST_CASE("thrust in slowly cut bone is 7 N within 10 % whatever the contact stiffness") {
    for (double stiffness : {500.0, 800.0, 2000.0, 5000.0}) {
        const Cut cut = press(stiffness, 0.4e-3, 12.0);
        INFO(stiffness << " N/m: mean " << cut.mean << " ripple " << cut.ripple << " peak " << cut.peak);
        CHECK(cut.mean == Approx(7.0).epsilon(0.1));
        CHECK(cut.ripple < 0.35);
        CHECK(cut.peak < 9.0);
    }
}

TEST_CASE("thrust falls in material that gives way fast") {
    const Cut hard = press(800.0, 0.4e-3, 8.0), soft = press(800.0, 4e-3, 5.0);
    CHECK(soft.mean < 0.95 * hard.mean);
    CHECK(soft.penetration > 2.0 * hard.penetration);
}

TEST_CASE("contact without tremor does not ring") {
    simulate::StrokePlan plan;
    plan.tremor.rms = 0.0;
    for (double stiffness : {500.0, 5000.0}) CHECK(press(stiffness, 0.0, 12.0, plan).ripple < 0.02);
}

TEST_CASE("the hand follows its strokes in free space within a millimetre") {
    simulate::StrokePlan plan;
    plan.feed_at = 1e9;
    plan.tremor.rms = 0.0;
    simulate::StrokeOperator intend(plan);
    simulate::Hand hand;
    double worst = 0.0, furthest = 0.0;
    for (int i = 0; i < 6000; ++i) {
        simulate::Intention last;
        const auto watch = [&](double h, const Wrench& force, const Pose& pose) noexcept {
            return last = intend(h, force, pose);
        };
        simulate::advance(hand, watch, {}, servo_period);
        worst = std::max(worst, glm::length(hand.pose.position - last.pose.position));
        furthest = std::max(furthest, std::abs(hand.pose.position.x));
    }
    CHECK(worst < 1e-3);
    CHECK(furthest == Approx(8e-3).epsilon(0.05));
}

TEST_CASE("tremor has the stated size and lies between 8 and 12 Hz") {
    const simulate::Tremor tremor{50e-6, {7}};
    double square = 0.0, speed_square = 0.0;
    const int count = 60'000;
    for (int i = 0; i < count; ++i) {
        Vec3 shake, speed;
        tremor.at(i * servo_period, shake, speed);
        square += shake.y * shake.y;
        speed_square += speed.y * speed.y;
    }
    CHECK(std::sqrt(square / count) == Approx(50e-6).epsilon(0.05));
    const double mean_hz = std::sqrt(speed_square / square) / (2.0 * std::numbers::pi);
    CHECK(mean_hz > 9.0);
    CHECK(mean_hz < 11.0);
}

TEST_CASE("an operator who is through pulls back to the start and lets go of the trigger") {
    simulate::StrokePlan plan;
    plan.depth = 10e-3;
    const Cut cut = press(800.0, 4e-3, 12.0, plan);
    CHECK(cut.intend.is_retracting());
    CHECK_FALSE(cut.intend.trigger());
    CHECK(glm::length(cut.hand.pose.position) < 0.5e-3);
}

TEST_CASE("an operator whose time is up pulls back too") {
    simulate::StrokePlan plan;
    plan.retract_at = 4.0;
    const Cut cut = press(800.0, 0.0, 7.0, plan);
    CHECK(glm::length(cut.hand.pose.position) < 0.5e-3);
}

TEST_CASE("an operator whose device gives no force any more pulls back, and comes in anew") {
    simulate::StrokePlan plan;
    plan.depth = 1.0;
    simulate::StrokeOperator intend(plan);
    simulate::Hand hand;
    double deepest = 0.0, highest = -1.0, thrust = 0.0;
    for (int i = 0; i < 12000; ++i) {
        // A wall at 5 mm. From 3 s to 5 s the device gives no force.
        const bool gives = i < 3000 || i >= 5000;
        const double inside = -5e-3 - hand.pose.position.z;
        thrust = gives && inside > 0.0 ? 2000.0 * inside : 0.0;
        simulate::advance(hand, intend, {{0.0, 0.0, thrust}, {}}, servo_period);
        if (gives) continue;
        deepest = std::max(deepest, inside);
        if (i >= 4500) highest = std::max(highest, hand.pose.position.z);
    }
    // What the springs of grip and wall held before, the blind way and a reaction; 2 s of feeding would be 60 mm.
    CHECK(deepest < plan.thrust / 800.0 + plan.thrust / 2000.0 + plan.blind_advance + 2e-3);
    CHECK(highest > -0.5e-3);
    CHECK(thrust == Approx(plan.thrust).epsilon(0.1));
    CHECK_FALSE(intend.is_retracting());
}

TEST_CASE("an operator who finds nothing where something was goes on to what lies behind") {
    simulate::StrokePlan plan;
    plan.depth = 1.0;
    simulate::StrokeOperator intend(plan);
    simulate::Hand hand;
    bool is_open = false;
    double thrust = 0.0;
    for (int i = 0; i < 15000; ++i) {
        // A wall at 5 mm that breaks after 3 s, and one 30 mm behind it.
        is_open = is_open || i >= 3000;
        thrust = 5000.0 * std::max(0.0, (is_open ? -35e-3 : -5e-3) - hand.pose.position.z);
        simulate::advance(hand, intend, {{0.0, 0.0, thrust}, {}}, servo_period);
    }
    CHECK(hand.pose.position.z < -35e-3);
    CHECK(thrust == Approx(plan.thrust).epsilon(0.1));
}

TEST_CASE("an operator notices a force as long after as the reaction time says") {
    for (const double delay : {0.0, 0.05, 0.2, 0.5}) {
        simulate::ReactionDelay noticed(delay);
        const double h = 0.25e-3;
        double at = -1.0;
        for (int i = 0; i < 8000 && at < 0.0; ++i)
            if (noticed(h, i >= 4000 ? 1.0 : 0.0) > 0.5) at = (i - 4000) * h;
        CHECK(at == Approx(delay).margin(1.1e-3));
    }
}

TEST_CASE("after a break-through an operator with a reaction time stops short of one who feeds on at once") {
    const auto plunge = [](double reaction) {
        simulate::StrokePlan plan;
        plan.tremor.rms = 0.0;
        plan.stroke_amplitude = 0.0;
        plan.depth = 1.0;
        plan.reaction_time = reaction;
        simulate::StrokeOperator intend(plan);
        simulate::Hand hand;
        double wall = 0.0;
        for (int i = 0; i < 4000; ++i) {
            // A wall of 5 N/mm at 10 mm, which is gone after 3.9 s.
            wall = std::max(0.0, -hand.pose.position.z - 10e-3);
            simulate::advance(hand, intend, {{0.0, 0.0, i < 3900 ? 5000.0 * wall : 0.0}, {}}, servo_period);
        }
        return -hand.pose.position.z;
    };
    const double at_once = plunge(0.0), late = plunge(0.15);
    CHECK(late > 10e-3);
    // For 0.1 s the late one still believes to press: the spring of the grip carries it 7 N / 0.8 N/mm further, and the
    // other feeds on as soon as it feels nothing.
    CHECK(at_once > late);
    CHECK(late == Approx(10e-3 + 7.0 / 800.0 + 7.0 / 5000.0).margin(2e-3));
}

TEST_CASE("an operator who reacts late still presses steadily, with any grip") {
    for (const double grip : {800.0, 2000.0, 6000.0}) {
        simulate::StrokePlan plan;
        plan.tremor.rms = 0.0;
        plan.stroke_amplitude = 0.0;
        plan.reaction_time = 0.2;
        plan.grip_stiffness = grip;
        simulate::StrokeOperator intend(plan);
        simulate::Hand hand;
        hand.dynamics.stiffness = grip;
        double least = 1e9, most = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const double force = 20000.0 * std::max(0.0, -hand.pose.position.z - 10e-3);
            simulate::advance(hand, intend, {{0.0, 0.0, force}, {}}, servo_period);
            if (i < 15000) continue;
            least = std::min(least, force);
            most = std::max(most, force);
        }
        CHECK(most - least < 0.1);
        CHECK(most == Approx(plan.thrust).epsilon(0.05));
    }
}

TEST_CASE("a firmer grip is stiffer at the same damping ratio, and 5 N is the usual hand") {
    const simulate::HandDynamics usual{}, soft = simulate::gripping(5.0), firm = simulate::gripping(50.0);
    CHECK(soft.stiffness == usual.stiffness);
    CHECK(soft.damping == usual.damping);
    CHECK(firm.stiffness == Approx(2.62 * usual.stiffness));
    CHECK(firm.damping / std::sqrt(firm.stiffness) == Approx(usual.damping / std::sqrt(usual.stiffness)));
    CHECK(simulate::gripping(0.0).stiffness > 0.0);
}

TEST_CASE("the trigger follows its times") {
    simulate::StrokePlan plan;
    plan.trigger_on = 0.2;
    plan.trigger_off = 0.4;
    simulate::StrokeOperator intend(plan);
    simulate::Hand hand;
    const auto at = [&](double until) {
        while (intend.time() < until - 1e-9) simulate::advance(hand, intend, {}, servo_period);
        return intend.trigger();
    };
    CHECK_FALSE(at(0.1));
    CHECK(at(0.3));
    CHECK_FALSE(at(0.5));
}

TEST_CASE("two operators with one seed are equal to the last bit, with another seed they are not") {
    simulate::StrokePlan plan;
    plan.tremor.random.seed = 3;
    const Cut a = press(800.0, 1e-3, 2.0, plan), b = press(800.0, 1e-3, 2.0, plan);
    plan.tremor.random.seed = 4;
    const Cut c = press(800.0, 1e-3, 2.0, plan);
    CHECK(a.hand.pose.position == b.hand.pose.position);
    CHECK(a.hand.twist.linear == b.hand.twist.linear);
    CHECK(a.hand.pose.position != c.hand.pose.position);
}
