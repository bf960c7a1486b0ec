// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/serial_gripper.hpp"

#include "dsp/core/error.hpp"
#include "tests/devices/gripper/stand_in.hpp"
#include "tests/support/catch.hpp"

#include <chrono>
#include <functional>
#include <thread>

using namespace tactus;
using tactus::test::StandInController;

namespace {

gripper::SerialGripperSettings settings_for(const StandInController& controller) {
    gripper::SerialGripperSettings s;
    s.port = controller.path;
    s.gauge[0] = {1.0 / 410.0, -100.0 / 410.0, 1.0, 0.0};
    return s;
}

/// Ticks at about 150 Hz until `until` or, as a way out for a broken program, 30 s.
template <class Until>
DeviceSample ticks(gripper::SerialGripper& gripper, const MotorDrive& drive, Until&& until) {
    DeviceSample sample;
    auto before = std::chrono::steady_clock::now();
    for (int n = 0; n < 4500; ++n) {
        std::this_thread::sleep_for(std::chrono::microseconds(6667));
        const auto now = std::chrono::steady_clock::now();
        sample = gripper.acquire(std::chrono::duration<double>(now - before).count());
        before = now;
        gripper.drive(drive);
        if (until(sample)) return sample;
    }
    FAIL("nothing came of it within 30 s");
    return sample;
}

MotorDrive speed(double v) {
    MotorDrive drive;
    drive.speed[0] = v;
    return drive;
}

}  // namespace

TEST_CASE("a gripper at a serial line moves as told and tells where it is and what it feels", "[kernel]") {
    StandInController controller;
    gripper::SerialGripper gripper(settings_for(controller));
    gripper.prepare(1.0 / 150.0);
    ticks(gripper, speed(0.05), [](const DeviceSample& s) { return s.valid && s.fingers[0].position > 0.005; });
    const DeviceSample at = ticks(gripper, speed(0.0), [&](const DeviceSample& s) {
        return s.valid && controller.told_speed == 0.0 && std::abs(s.fingers[0].position - controller.position) < 1e-6;
    });
    // Away from the cord's middle the springs pull it back.
    const DeviceSample still =
        ticks(gripper, speed(0.0), [&](const DeviceSample& s) { return s.counter > at.counter + 20; });
    CHECK(still.fingers[0].force == Approx(-380.0 * still.fingers[0].position).margin(0.01));
    CHECK(controller.bad == 0);
}

TEST_CASE("noise and losses on the line cost samples, never truth", "[kernel]") {
    StandInController controller;
    controller.trouble.corrupt_percent = 30;
    controller.trouble.drop_percent = 20;
    controller.trouble.delay_frames = 5;
    gripper::SerialGripper gripper(settings_for(controller));
    gripper.prepare(1.0 / 150.0);
    double worst = 0.0;
    ticks(gripper, speed(0.03), [&](const DeviceSample& s) {
        worst = std::max(worst, std::abs(s.fingers[0].position));
        return s.valid && gripper.frames().bad_checksum > 50 && gripper.counts().lost > 50;
    });
    CHECK(worst < 1.0);  // a flipped bit of a position would be anywhere within 600 m
}

TEST_CASE("a controller that falls silent, is not valid and holds, and back again it goes on", "[kernel]") {
    StandInController controller;
    gripper::SerialGripper gripper(settings_for(controller));
    gripper.prepare(1.0 / 150.0);
    const auto is_valid_sample = [](const DeviceSample& s) { return s.valid; };
    ticks(gripper, speed(0.01), is_valid_sample);
    controller.trouble.silent = true;
    const DeviceSample lost = ticks(gripper, speed(0.0), [](const DeviceSample& s) { return !s.valid; });
    controller.trouble.silent = false;
    const DeviceSample back = ticks(gripper, speed(0.0), is_valid_sample);
    CHECK(back.counter > lost.counter);
    // Without drives the controller stops by itself.
    ticks(gripper, speed(0.02), [&](const DeviceSample&) { return !controller.holds; });
    for (int n = 0; n < 3000 && !controller.holds; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(controller.holds);
    CHECK(controller.told_speed == 0.0);
}

TEST_CASE("a line that is pulled makes samples invalid and drives no harm", "[kernel]") {
    StandInController controller;
    gripper::SerialGripper gripper(settings_for(controller));
    gripper.prepare(1.0 / 150.0);
    ticks(gripper, speed(0.01), [](const DeviceSample& s) { return s.valid; });
    controller.disconnect();
    ticks(gripper, speed(0.01), [](const DeviceSample& s) { return !s.valid; });
    for (int n = 0; n < 100; ++n) {
        CHECK_FALSE(gripper.acquire(1.0 / 150.0).valid);
        gripper.drive(speed(0.01));
    }
    CHECK(gripper.counts().unsent > 50);
}

TEST_CASE("a gripper that is let go is told to hold, and so is one whose speed is not a number", "[kernel]") {
    StandInController controller;
    {
        gripper::SerialGripper gripper(settings_for(controller));
        gripper.prepare(1.0 / 150.0);
        ticks(gripper, speed(0.02), [&](const DeviceSample&) { return !controller.holds; });
        ticks(gripper, speed(NAN), [&](const DeviceSample&) { return controller.holds.load(); });
        ticks(gripper, speed(0.9), [&](const DeviceSample&) { return controller.told_speed > 0.0; });
        CHECK(controller.told_speed == Approx(0.07));
    }
    for (int n = 0; n < 3000 && !controller.holds; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(controller.holds);
}

TEST_CASE("a port that is none is refused with its name") {
    gripper::SerialGripperSettings s;
    s.port = "/dev/null";
    CHECK_THROWS_WITH(gripper::SerialGripper(s), Catch::Matchers::ContainsSubstring("/dev/null") &&
                                                     Catch::Matchers::ContainsSubstring("not a serial line"));
    s.port = "/nowhere/tty";
    CHECK_THROWS_WITH(gripper::SerialGripper(s), Catch::Matchers::ContainsSubstring("cannot open /nowhere/tty"));
}
