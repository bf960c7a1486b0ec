// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

using namespace tactus;
using test::NodeHarness;

TEST_CASE("two balls that overlap by 1 mm at 0.8 N/mm push 0.8 N apart along the line of centres") {
    NodeHarness node("sphere_contact", test::servo);
    node.set("centre", "10 mm, 0 mm, 0 mm");
    const Vec3 direction = glm::normalize(Vec3(1.0, 2.0, -2.0));
    node.feed<Pose>("pose", [&](std::int64_t k) {
        return Pose{Vec3(0.01, 0.0, 0.0) + direction * (k == 0 ? 0.054 : 0.0551), rotation_by({0.1, 0.2, 0.3})};
    });
    node.prepare();
    node.run(2);
    const auto wrenches = node.values<Wrench>("wrench");
    CHECK(glm::length(wrenches[0].force - direction * 0.8) < 1e-9);
    CHECK(wrenches[0].torque == Vec3(0.0));
    CHECK(node.values<double>("penetration")[0] == Approx(1e-3));
    CHECK(node.values<bool>("in_contact")[0]);
    CHECK(wrenches[1].force == Vec3(0.0));
    CHECK_FALSE(node.values<bool>("in_contact")[1]);
}

TEST_CASE("a spring pulls along the offset, turns the shorter way, and damps the relative velocity") {
    NodeHarness node("spring", test::servo);
    node.set("stiffness", "0.5 N/mm").set("damping", "4 N s/m");
    node.set("angular_stiffness", "2 N m/rad").set("angular_damping", "0.1 N m s/rad");
    const Quat turned = rotation_by({0.0, 0.3, 0.0});
    node.feed("device", Pose{{0.001, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    // The same rotation written with the opposite sign must not go the long way round.
    node.feed("object", Pose{{0.003, 0.0, 0.0}, -turned});
    node.feed("device_twist", Twist{{0.0, 0.5, 0.0}, {0.0, 0.0, 2.0}});
    node.feed("object_twist", Twist{{0.0, 0.25, 0.0}, {}});
    node.prepare();
    node.run(1);
    const Wrench w = node.last<Wrench>("wrench");
    CHECK(w.force.x == Approx(1.0));
    CHECK(w.force.y == Approx(-1.0));
    CHECK(w.torque.y == Approx(0.6));
    CHECK(w.torque.z == Approx(-0.2));
}

TEST_CASE("nowhere within a ball is the force small, so that a hand that begins there is told from one in free space") {
    for (const double distance : {0.0, 1e-9, 1e-3, 20e-3, 40e-3}) {
        NodeHarness node("sphere_contact", test::servo);
        node.feed<Pose>("pose", [&](std::int64_t) { return Pose{Vec3(distance, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}}; });
        node.prepare();
        node.run(1);
        CHECK(glm::length(node.values<Wrench>("wrench").back().force) == Approx(800.0 * (55e-3 - distance)));
    }
}
