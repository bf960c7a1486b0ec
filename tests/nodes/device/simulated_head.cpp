// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

using namespace tactus;
using test::NodeHarness;

TEST_CASE("a simulated head sways as far as it is told and keeps its eyes on what it looks at") {
    NodeHarness node("simulated_head", {.period = flicks_per_second / 60});
    node.set("position", "0 mm, -500 mm, 400 mm").set("look_at", "10 mm, 20 mm, -30 mm");
    node.set("sway", "150 mm, 0 mm, 0 mm").set("frequency", "0.5 Hz");
    node.prepare();
    node.run(240);
    double reach = 0.0;
    for (const Pose& head : node.values<Pose>("pose")) {
        CHECK(is_valid(head));
        CHECK(head.position.y == Approx(-0.5));
        reach = std::max(reach, std::abs(head.position.x));
        const Vec3 towards = glm::normalize(Vec3(0.01, 0.02, -0.03) - head.position);
        CHECK(glm::dot(head.rotate(Vec3(0.0, 0.0, -1.0)), towards) == Approx(1.0));
        // The eyes are level.
        CHECK(head.rotate(Vec3(1.0, 0.0, 0.0)).z == Approx(0.0).margin(1e-12));
        CHECK(head.rotate(Vec3(1.0, 0.0, 0.0)).x > 0.9);
    }
    CHECK(reach == Approx(0.15).epsilon(0.001));
}
