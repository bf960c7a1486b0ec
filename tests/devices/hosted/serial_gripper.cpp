// SPDX-License-Identifier: Apache-2.0
// The gripper at a serial line, in a process of its own as in a live run.
#include "tests/devices/gripper/stand_in.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::test;

TEST_CASE("a gripper at a serial line has a process of its own, and holds when its engine is gone", "[kernel]") {
    const WatchedHost host;
    StandInController controller;
    const hosted::DeviceRequest request{
        "serial_gripper", "device 'gripper'", {{"port", controller.path, {}}, {"newton_per_count", "2.44 mN", {}}}, {}};
    MotorDrive close;
    close.speed[0] = 0.05;
    const auto drives = [&](HapticDevice& device, const MotorDrive& drive, const auto& until) {
        return wait_until([&] {
            device.acquire(1e-3);
            device.commit({});
            device.drive(drive);
            return until(device.acquire(0.0));
        });
    };
    {
        const auto device = hosted::open_placed(request, [](const std::string& name) { return name; });
        REQUIRE(dynamic_cast<hosted::HostedDevice*>(device.get()) != nullptr);
        device->prepare(1.0 / 150.0);
        CHECK(device->info().fingers == 1);
        CHECK(drives(*device, close, [&](const DeviceSample& sample) {
            return sample.valid && sample.fingers[0].position > 5e-3 && controller.told_speed > 0.04;
        }));
        const std::uint64_t before = controller.drives;
        CHECK(wait_until([&] { return controller.told_speed == 0.0; }));  // the engine is silent
        CHECK(controller.drives > before);
        CHECK_FALSE(controller.holds);  // told to stand, by a process that goes on
        CHECK(drives(*device, close,
                     [&](const DeviceSample& sample) { return sample.valid && controller.told_speed > 0.04; }));
    }
    CHECK(wait_until([&] { return controller.holds.load(); }));
    CHECK(controller.told_speed == 0.0);
    CHECK(controller.bad == 0);
    CHECK(wait_until([&] { return ::waitpid(-1, nullptr, WNOHANG) < 0; }));
}
