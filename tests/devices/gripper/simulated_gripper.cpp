// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;

namespace {

std::unique_ptr<HapticDevice> open(const std::string& driver, std::vector<OptionText> given = {}) {
    Options options("device 'grip'", std::move(given));
    auto device = haptic::open_haptic_device(driver, {}, options, [](const std::string& name) { return name; });
    device->prepare(1.0 / 150.0);
    return device;
}

DeviceSample run_patch(HapticDevice& device, double speed, double seconds) {
    MotorDrive drive;
    drive.speed = {speed, -speed};
    DeviceSample sample;
    for (int n = 0; n < static_cast<int>(seconds * 150); ++n) {
        sample = device.acquire(1.0 / 150.0);
        device.drive(drive);
    }
    return sample;
}

}  // namespace

TEST_CASE("the walking gripper has one finger, 70 mm/s and an encoder of 16 000 pulses per mm of the rod") {
    const auto device = open("wqsm_gripper", {{"held_by", "hand", {}}, {"hand_stiffness", "0 N/mm", {}}});
    CHECK(device->info().fingers == 1);
    CHECK(device->info().max_speed == Approx(0.07));
    const double x = run_patch(*device, 1.0, 1.02).fingers[0].position;
    CHECK(x == Approx(0.07).epsilon(0.01));
    const double pulse = 4.5e-3 / 16000.0;
    CHECK(std::abs(x / pulse - std::nearbyint(x / pulse)) < 1e-6);
}

TEST_CASE("the wave gripper has two fingers, counts 4000 pulses per turn and stands still in its dead zone") {
    const auto device = open("twum_gripper", {{"held_by", "hand", {}}, {"hand_stiffness", "0 N/mm", {}}});
    CHECK(device->info().fingers == 2);
    const DeviceSample moved = run_patch(*device, 0.1, 0.5);
    CHECK(moved.fingers[0].position == Approx(0.05).epsilon(0.05));
    CHECK(moved.fingers[1].position == Approx(-0.05).epsilon(0.05));
    const double pulse = 2.0 * 3.14159265358979 * 0.07 / 4000.0;
    CHECK(std::abs(moved.fingers[0].position / pulse - std::nearbyint(moved.fingers[0].position / pulse)) < 1e-6);
    const double before = run_patch(*device, 0.0, 0.1).fingers[0].position;
    CHECK(run_patch(*device, 0.014, 1.0).fingers[0].position == before);
}

TEST_CASE("planted faults come when they are told to") {
    const auto nan =
        open("wqsm_gripper", {{"fault", "nan", {}}, {"fault_at", "1 s", {}}, {"fault_until", "1.5 s", {}}});
    CHECK(std::isfinite(run_patch(*nan, 0.0, 0.9).fingers[0].force));
    CHECK_FALSE(std::isfinite(run_patch(*nan, 0.0, 0.2).fingers[0].force));
    CHECK(std::isfinite(run_patch(*nan, 0.0, 0.6).fingers[0].force));
    const auto unplugged = open("twum_gripper", {{"fault", "unplugged", {}}, {"fault_at", "0.5 s", {}}});
    CHECK(run_patch(*unplugged, 0.0, 0.4).valid);
    CHECK_FALSE(run_patch(*unplugged, 0.0, 0.2).valid);
}

TEST_CASE("wrong options are refused by name") {
    CHECK_THROWS_WITH(open("wqsm_gripper", {{"lever", "70 mm", {}}}), Catch::Matchers::ContainsSubstring("lever"));
    CHECK_THROWS_WITH(open("twum_gripper", {{"delay", "1.5", {}}}), Catch::Matchers::ContainsSubstring("whole number"));
    CHECK_THROWS_WITH(open("serial_gripper", {{"baud", "12345", {}}}), Catch::Matchers::ContainsSubstring("baud"));
}
