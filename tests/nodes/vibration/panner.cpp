// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>
#include <limits>

using namespace tactus;
using test::NodeHarness;

TEST_CASE("a panner keeps the energy, or the sum of amplitudes, wherever the signal is felt") {
    for (const bool is_linear : {false, true}) {
        NodeHarness node("panner");
        node.set("law", is_linear ? "linear" : "energy").feed<float>("in", [](std::int64_t) { return 3.0f; });
        node.feed<double>("place", [](std::int64_t k) { return static_cast<double>(k) / 1000.0; });
        node.prepare();
        node.run(1001, 7);
        const auto left = node.values<float>("left"), right = node.values<float>("right");
        for (std::size_t i = 0; i < left.size(); ++i) {
            const double a = static_cast<double>(left[i]) / 3.0, b = static_cast<double>(right[i]) / 3.0;
            CHECK((is_linear ? a + b : a * a + b * b) == Approx(1.0).margin(1e-6));
            CHECK((is_linear ? b : b * b) == Approx(static_cast<double>(i) / 1000.0).margin(1e-6));
        }
        CHECK(right.front() == 0.0f);
        CHECK(left.back() == 0.0f);
    }
}

TEST_CASE("a panner takes a place beyond its actuators as the nearer one, and no place as the middle") {
    NodeHarness node("panner");
    node.set("law", "linear").feed<float>("in", [](std::int64_t) { return 1.0f; });
    node.feed<double>("place", [](std::int64_t k) {
        return k == 0 ? -4.0 : k == 1 ? 7.0 : std::numeric_limits<double>::quiet_NaN();
    });
    node.prepare();
    node.run(3, 1);
    const auto left = node.values<float>("left");
    CHECK(left[0] == 1.0f);
    CHECK(left[1] == 0.0f);
    CHECK(left[2] == 0.5f);
}
