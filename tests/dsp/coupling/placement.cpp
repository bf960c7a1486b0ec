// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/placement.hpp"

#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"

#include <numbers>

using namespace tactus;

namespace {

const coupling::Placement placement{{{0.1, -0.2, 0.3}, coupling::rotation_xyz({0.4, -0.9, 2.1})},
                                    1.7,
                                    {{0.02, 0.05, -0.11}, coupling::rotation_xyz({1.0, 0.2, -0.5})}};

}  // namespace

TEST_CASE("a placement turns about x first, then y, then z") {
    const double quarter = std::numbers::pi / 2.0;
    CHECK(glm::length(coupling::rotation_xyz({quarter, 0.0, 0.0}) * Vec3(0.0, 1.0, 0.0) - Vec3(0.0, 0.0, 1.0)) < 1e-12);
    CHECK(glm::length(coupling::rotation_xyz({quarter, 0.0, quarter}) * Vec3(0.0, 1.0, 0.0) - Vec3(0.0, 0.0, 1.0)) <
          1e-12);
    CHECK(glm::length(coupling::rotation_xyz({quarter, quarter, 0.0}) * Vec3(0.0, 1.0, 0.0) - Vec3(1.0, 0.0, 0.0)) <
          1e-12);
}

TEST_CASE("the hand does the work that the tool does, whatever the placement, the grip and the scale") {
    const Pose handle{{0.03, 0.01, -0.02}, rotation_by({0.3, 0.7, -0.2})};
    const Twist motion{{0.2, -0.1, 0.05}, {0.6, -1.1, 0.4}};
    const Wrench on_tool{{3.0, -5.0, 2.0}, {0.1, 0.2, -0.3}};
    const double dt = 1e-6;
    const auto moved = [&](double t) {
        return placement.tool(
            {handle.position + motion.linear * t, rotation_by(motion.angular * t) * handle.orientation});
    };
    const Pose tool = moved(0.0), before = moved(-dt), after = moved(dt);
    const Vec3 velocity = (after.position - before.position) / (2.0 * dt);
    const Vec3 spin = rotation_between(before.orientation, after.orientation) / (2.0 * dt);
    const double scene = glm::dot(on_tool.force, velocity) + glm::dot(on_tool.torque, spin);

    const Wrench on_hand = coupling::wrench_on_hand(on_tool, tool.position, placement.frame(handle), placement.scale);
    const double hand = glm::dot(on_hand.force, motion.linear) + glm::dot(on_hand.torque, motion.angular);
    CHECK(std::abs(scene) > 0.1);
    CHECK(hand == Approx(scene).epsilon(1e-7));
}

TEST_CASE("a tool away from the handle turns a pure force into a torque on the hand") {
    const coupling::Placement grip{{}, 1.0, {{0.0, 0.0, -0.1}, {1.0, 0.0, 0.0, 0.0}}};
    const Wrench on_hand = coupling::wrench_on_hand({{2.0, 0.0, 0.0}, {}}, grip.tool({}).position, grip.frame({}), 1.0);
    CHECK(on_hand.force.x == Approx(2.0));
    CHECK(on_hand.torque.y == Approx(-0.2));
}
