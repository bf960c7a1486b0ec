// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_limiter.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr Flicks period = flicks_per_second / 150;

/// A controller whose motor is ideal: each tick the finger goes where it was told.
struct Held {
    NodeHarness node{"admittance_controller", {.period = period, .max_frames = 1}};
    double position = 0.0, force = 0.0, fault = 0.0;
    bool stuck = false, slips = false;

    Held() {
        node.feed<double>("force", [this](std::int64_t) { return force; });
        node.feed<double>("position", [this](std::int64_t) { return position; });
        node.feed<bool>("slips", [this](std::int64_t) { return slips; });
        node.feed<double>("fault", [this](std::int64_t) { return fault; });
    }
    double tick() {
        node.run(1);
        const double speed = node.last<double>("velocity");
        if (!stuck) position += speed / 150.0;
        return speed;
    }
    void ticks(int count) {
        for (int n = 0; n < count; ++n) tick();
    }
};

}  // namespace

TEST_CASE("a controller brings the finger to F/k") {
    Held held;
    held.node.prepare();
    held.ticks(2);
    held.force = 3.0;
    held.ticks(200);
    CHECK(held.position == Approx(3e-3).epsilon(1e-6));
    CHECK(held.node.last<double>("wanted") == Approx(3e-3).epsilon(1e-6));
}

TEST_CASE("an unstable gain is refused when the patch is read, with the limit, unless it is wanted") {
    Held held;
    held.node.set("gain", "120 s^-1");
    CHECK_THROWS_WITH(held.node.prepare(), Catch::Matchers::ContainsSubstring("unstable") &&
                                               Catch::Matchers::ContainsSubstring("the limit is"));
    held.node.set("allow_unstable", "true");
    held.node.prepare();
    held.tick();
    CHECK(held.node.last<double>("used_gain") == 120.0);
    Held soft;
    soft.node.set("sides", "one").set("free_damping", "20 N s/m");
    CHECK_THROWS_WITH(soft.node.prepare(), Catch::Matchers::ContainsSubstring("no gain is stable") &&
                                               Catch::Matchers::ContainsSubstring("free_damping"));
    Held nothing;
    nothing.node.set("stiffness", "0 N/mm");
    CHECK_THROWS_WITH(nothing.node.prepare(), Catch::Matchers::ContainsSubstring("give a damping"));
    Held no_table;
    no_table.node.set("object", "table");
    CHECK_THROWS_WITH(no_table.node.prepare(), Catch::Matchers::ContainsSubstring("asset"));
}

TEST_CASE("while it runs an unstable change is refused and the last good settings hold") {
    Held held;
    held.node.prepare();
    held.force = 1.0;
    held.ticks(100);
    const double gain = held.node.last<double>("used_gain");
    held.node.set("gain", "5000 s^-1");
    held.tick();
    CHECK(held.node.last<bool>("refused"));
    CHECK(held.node.last<double>("used_gain") == gain);
    held.node.set("gain", "20 s^-1");
    held.tick();
    CHECK_FALSE(held.node.last<bool>("refused"));
    CHECK(held.node.last<double>("used_gain") == 20.0);
}

TEST_CASE("another object takes over without a jump") {
    Held held;
    held.node.prepare();
    held.tick();
    held.force = 2.0;
    held.ticks(300);
    const double before = held.node.last<double>("wanted");
    held.node.set("stiffness", "0.2 N/mm");
    double largest = 0.0, last = before;
    for (int n = 0; n < 300; ++n) {
        held.tick();
        const double now = held.node.last<double>("wanted");
        largest = std::max(largest, std::abs(now - last));
        last = now;
    }
    CHECK(before == Approx(2e-3).epsilon(1e-3));
    CHECK(last == Approx(10e-3).epsilon(1e-3));
    CHECK(largest < 0.6e-3);  // 8 mm in one step would be a jump; 100 ms let it go by at most 7 % per tick
}

TEST_CASE("feed-forward takes away the lag behind a steadily moving object") {
    for (const char* share : {"0", "1"}) {
        Held held;
        held.node.set("stiffness", "0 N/mm").set("damping", "100 N s/m").set("feed_forward", share);
        held.node.prepare();
        held.tick();
        held.force = 2.0;  // 20 mm/s
        held.ticks(400);
        const double seen = held.position;
        held.tick();
        const double lag = held.node.last<double>("wanted") - seen;
        const double expected = share[0] == '0' ? 0.02 / held.node.last<double>("used_gain") : 0.0;
        CHECK(lag == Approx(expected).margin(2e-5));
    }
}

TEST_CASE("a force that is not a number, or a sensor that is gone, stops the motor for its reason until asked") {
    for (const control::Fault why :
         {control::Fault::not_finite, control::Fault::invalid_input, control::Fault::stale_input}) {
        Held held;
        held.node.prepare();
        held.tick();
        held.force = 2.0;
        held.ticks(3);
        if (why == control::Fault::not_finite) held.force = NAN;
        else held.fault = static_cast<double>(why);
        CHECK(held.tick() == 0.0);
        CHECK(held.node.last<bool>("holds"));
        CHECK(held.node.last<double>("reason") == static_cast<double>(why));
        held.force = 2.0;
        held.fault = 0.0;
        held.ticks(100);
        CHECK(held.tick() == 0.0);  // good again is not enough
        const double at = held.position;
        held.node.set("recover", "1");
        held.tick();
        CHECK_FALSE(held.node.last<bool>("holds"));
        CHECK(held.node.last<double>("wanted") == Approx(at).margin(1e-12));  // from where it is
        held.ticks(400);
        CHECK(held.position == Approx(2e-3).epsilon(1e-3));
        const Report report = held.node.report();
        CHECK(std::get<double>(report.sections.at("node").at("faults")) == 1.0);
        CHECK(std::get<std::string>(report.sections.at("node").at("fault")) == control::describe(why));
    }
}

TEST_CASE("asking does not help while the sensor is still bad") {
    Held held;
    held.node.prepare();
    held.tick();
    held.force = NAN;
    held.tick();
    held.node.set("recover", "1");
    held.ticks(3);
    CHECK(held.node.last<bool>("holds"));
}

TEST_CASE("an encoder that stands still while the motor runs is found within 15 mm of lost way") {
    Held held;
    held.node.prepare();
    held.tick();
    held.stuck = true;
    held.force = 5.0;
    int ran = 0;
    while (ran < 100 && held.tick() != 0.0) ++ran;
    CHECK(ran * 0.07 / 150.0 < 0.015);
    CHECK(held.node.last<double>("reason") == static_cast<double>(control::Fault::stuck_encoder));
    Held stalled;
    stalled.node.prepare();
    stalled.tick();
    stalled.stuck = stalled.slips = true;
    stalled.force = 5.0;
    stalled.ticks(100);
    CHECK_FALSE(stalled.node.last<bool>("holds"));
}

TEST_CASE("a motor that a hand holds still is stalled, and its encoder is not called stuck") {
    Held held;
    held.node.set("stiffness", "0.2 N/mm").set("rest", "30 mm");
    held.node.prepare();
    held.tick();
    held.stuck = true;
    held.force = -3.0;  // the object pulls the finger to +30 mm, the hand holds it back
    held.ticks(200);
    CHECK(held.node.last<double>("velocity") > 0.04);
    CHECK_FALSE(held.node.last<bool>("holds"));
    // The hand lets go, and still nothing moves.
    held.force = -1.0;
    held.ticks(60);
    CHECK(held.node.last<double>("reason") == static_cast<double>(control::Fault::stuck_encoder));
}

TEST_CASE("a gripper's output refuses what its motor may not, and goes on when asked") {
    NodeHarness node("gripper_output", {.period = period, .max_frames = 1});
    double speed = 0.05;
    node.feed<double>("finger_speed", [&](std::int64_t) { return speed; });
    node.disconnect_optional();
    node.prepare();
    const auto given = [&] {
        node.run(1);
        return node.host.devices.begin()->second->motors.speed[0];
    };
    CHECK(given() == 0.05);
    for (const double bad : {0.071, -1.0, static_cast<double>(NAN)}) {
        speed = bad;
        CHECK(given() == 0.0);
        CHECK(node.host.devices.begin()->second->fault ==
              (std::isnan(bad) ? control::Fault::not_finite : control::Fault::beyond_drive_limit));
        speed = 0.02;
        CHECK(given() == 0.0);
        node.set("recover", std::isnan(bad) ? "3" : bad > 0.0 ? "1" : "2");
        CHECK(given() == 0.02);
        CHECK(node.host.devices.begin()->second->fault == control::Fault::none);
    }
    node.host.devices.begin()->second->hold_off = true;
    CHECK(given() == 0.0);
}

TEST_CASE("a gripper's input tells what is wrong and keeps the last good position") {
    NodeHarness node("gripper_input", {.period = period, .max_frames = 1});
    DeviceSample sample;
    sample.valid = true;
    bool counts = true;
    node.device_feed = [&](std::int64_t, DevicePort& port) {
        sample.counter += counts;
        port.sample = sample;
    };
    node.prepare();
    sample.fingers[0] = {0.01, 1.5, motor_slips};
    node.run(1);
    CHECK(node.last<double>("finger_position") == 0.01);
    CHECK(node.last<double>("finger_force") == 1.5);
    CHECK(node.last<bool>("slips"));
    CHECK(node.last<double>("fault") == 0.0);
    counts = false;
    node.run(10);
    CHECK(node.last<double>("fault") == static_cast<double>(control::Fault::stale_input));
    counts = true;
    sample.fingers[0].force = NAN;
    node.run(1);
    CHECK(node.last<double>("fault") == static_cast<double>(control::Fault::not_finite));
    CHECK(node.last<double>("finger_position") == 0.01);
    CHECK(node.last<double>("finger_force") == 0.0);
    sample.valid = false;
    node.run(1);
    CHECK(node.last<double>("fault") == static_cast<double>(control::Fault::invalid_input));
}

TEST_CASE("the rig swings 50 mm at its rate, and a sweep gets faster without a jump") {
    NodeHarness node("test_rig", {.period = period, .max_frames = 1});
    node.set("swings", "0.5 Hz").feed<double>("finger", 0.0);
    node.prepare();
    node.run(150);
    const auto cord = node.values<double>("cord");
    CHECK(cord[74] == Approx(0.025 * std::sin(3.14159265358979 * 75 / 150.0)).margin(1e-12));
    CHECK(node.last<double>("spring_force") == Approx(380.0 * cord[148]));
    CHECK(std::get<double>(node.report().sections.at("rig").at("peak_cord_speed_mm_s")) == Approx(78.54).epsilon(1e-4));
    NodeHarness sweep("test_rig", {.period = period, .max_frames = 1});
    sweep.set("swings", "0.5 Hz").set("sweep_to", "2 Hz").set("sweep_time", "10 s").feed<double>("finger", 0.0);
    sweep.prepare();
    sweep.run(1800);
    const auto path = sweep.values<double>("cord");
    for (std::size_t n = 1; n < path.size(); ++n)
        CHECK(std::abs(path[n] - path[n - 1]) < 0.025 * 6.2832 * 2.01 / 150.0);
    CHECK(sweep.last<double>("swing_rate") == Approx(2.0));
}

TEST_CASE("a weight is felt when it is gripped hard enough, and slides when it is not") {
    for (const double grip : {0.0, 1.0, 4.0}) {
        NodeHarness node("held_weight", {.period = flicks_per_second / 1000, .max_frames = 1});
        node.set("threshold", "0 N").feed<double>("grip_force", grip);
        node.feed<Pose>("hand", [](std::int64_t k) {
            Pose pose;
            pose.position.z = 0.05 * std::min(1.0, static_cast<double>(k) / 1000.0);
            return pose;
        });
        node.feed<Twist>("hand_twist", Twist{});
        node.prepare();
        node.run(3000);
        const double felt = node.last<Wrench>("wrench").force.z, height = node.last<double>("height");
        if (grip == 4.0) {
            CHECK(felt == Approx(-0.2 * 9.81).epsilon(1e-3));
            CHECK(height == Approx(0.05 - 0.2 * 9.81 / 600.0).margin(1e-3));
            CHECK_FALSE(node.last<bool>("slides"));
        } else {
            CHECK(std::abs(felt) <= 2.0 * 0.6 * grip + 1e-9);
            CHECK(height < 1e-3);
        }
    }
}

TEST_CASE("with default parameters an object of 0.2 N/mm is stable in fingers of 0.2 to 3 N/mm") {
    for (const double finger : {200.0, 500.0, 1500.0, 3000.0}) {
        Held held;
        held.node.set("stiffness", "0.2 N/mm");
        held.node.prepare();
        double most = 0.0, late = 0.0;
        for (int n = 0; n < 900; ++n) {
            // The finger is held still after a knock of 1 mm.
            held.force = finger * ((n < 10 ? 1e-3 : 0.0) - held.position);
            held.tick();
            most = std::max(most, std::abs(held.position));
            if (n >= 750) late = std::max(late, std::abs(held.position));
        }
        CAPTURE(finger);
        CHECK(most > 0.05e-3);
        CHECK(late < 0.05e-3);
    }
}
