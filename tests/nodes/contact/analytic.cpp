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

TEST_CASE("a tool that goes through the centre of a ball feels no jump, and gets nothing for it") {
    NodeHarness node("sphere_contact", test::servo);
    node.set("radius", "0.3 mm").set("tool_radius", "0.2 mm").set("stiffness", "20 N/mm");
    constexpr int ticks = 4000;
    // From outside through the centre to the other side, 0.3 µm per tick.
    node.feed<Pose>("pose", [](std::int64_t k) {
        return Pose{Vec3(0.6e-3 - 0.3e-6 * static_cast<double>(k), 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};
    });
    node.prepare();
    node.run(ticks);
    const auto wrenches = node.values<Wrench>("wrench");
    double step = 0.0, largest = 0.0, work = 0.0;
    for (std::size_t k = 1; k < wrenches.size(); ++k) {
        step = std::max(step, std::abs(wrenches[k].force.x - wrenches[k - 1].force.x));
        largest = std::max(largest, std::abs(wrenches[k].force.x));
        work += 0.5 * (wrenches[k].force.x + wrenches[k - 1].force.x) * -0.3e-6;
    }
    CHECK(largest == Approx(5.0).epsilon(1e-3));  // at half of the sum of the radii
    CHECK(step <= 2.0 * 20e3 * 0.3e-6 * 1.001);
    CHECK(std::abs(work) < 1e-9);
}
