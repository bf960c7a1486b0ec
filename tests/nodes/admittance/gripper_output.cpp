// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <limits>

using namespace tactus;
using control::Fault, control::ForceState;

namespace {

struct Gripper {
    test::NodeHarness node{"gripper_output", test::servo};

    Gripper() {
        node.disconnect_optional();
        node.connect("fault");
        node.feed<double>("finger_speed", 0.01);
        node.feed<double>("fault", 0.0);
    }
    const DevicePort& port() { return *node.host.devices.at(""); }
};

}  // namespace

TEST_CASE("a fault that comes by a wire holds a gripper until its source goes on, not until a person asks this node") {
    Gripper gripper;
    gripper.node.feed<double>("fault",
                              [](std::int64_t k) { return k < 100 ? static_cast<double>(Fault::stuck_encoder) : 0.0; });
    gripper.node.prepare();
    gripper.node.run(50);
    CHECK(gripper.port().fault == Fault::stuck_encoder);
    CHECK(gripper.port().state == ForceState::by_source);
    CHECK(gripper.port().motors.speed[0] == 0.0);
    CHECK(gripper.node.last<bool>("holds"));
    gripper.node.run(60);
    CHECK(gripper.port().state == ForceState::on);
    CHECK(gripper.port().motors.speed[0] == Approx(0.01));
    CHECK_FALSE(gripper.node.last<bool>("holds"));
}

TEST_CASE("a gripper holds while a value that its motors depend on is overdue") {
    Gripper gripper;
    gripper.node.device_feed = [](std::int64_t k, DevicePort& port) {
        port.overdue = k >= 100 && k < 150 ? Fault::late_value : Fault::none;
    };
    gripper.node.prepare();
    gripper.node.run(120);
    CHECK(gripper.port().motors.speed[0] == 0.0);
    CHECK(gripper.port().fault == Fault::late_value);
    gripper.node.run(60);
    CHECK(gripper.port().motors.speed[0] == Approx(0.01));
    CHECK(gripper.port().fault == Fault::none);
}

TEST_CASE("a gripper's own fault waits for a person") {
    Gripper gripper;
    gripper.node.feed<double>("finger_speed",
                              [](std::int64_t k) { return k == 10 ? std::numeric_limits<double>::quiet_NaN() : 0.01; });
    gripper.node.prepare();
    gripper.node.run(50);
    CHECK(gripper.port().fault == Fault::not_finite);
    CHECK(gripper.port().state == ForceState::by_hand);
    gripper.node.set("recover", "1");
    gripper.node.run(10);
    CHECK(gripper.port().state == ForceState::on);
}

TEST_CASE("a gripper's node that an edit prepares does not move the motors or the cord of the one that drives") {
    Gripper gripper;
    gripper.node.connect("cord");
    gripper.node.feed<double>("cord", 0.02);
    gripper.node.prepare();
    gripper.node.run(10);
    REQUIRE(gripper.port().motors.cord == 0.02);
    Gripper next;
    next.node.host.devices = std::move(gripper.node.host.devices);
    next.node.prepare();
    CHECK(next.port().motors.cord == 0.02);
    CHECK(next.port().motors.speed[0] == 0.01);
}

TEST_CASE("a gripper's node that an edit prepares keeps the fault that is on until a person asks") {
    Gripper gripper;
    gripper.node.feed<double>("finger_speed", std::numeric_limits<double>::quiet_NaN());
    gripper.node.prepare();
    gripper.node.run(10);
    REQUIRE(gripper.port().state == ForceState::by_hand);
    Gripper next;
    next.node.host.devices = std::move(gripper.node.host.devices);
    next.node.prepare();
    next.node.run(10);
    CHECK(next.port().state == ForceState::by_hand);
    CHECK(next.port().fault == Fault::not_finite);
    CHECK(next.port().motors.speed[0] == 0.0);
    next.node.set("recover", "1");
    next.node.run(10);
    CHECK(next.port().state == ForceState::on);
}
