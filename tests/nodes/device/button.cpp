// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>

using namespace tactus;
using test::NodeHarness;

TEST_CASE("a button is pressed for a moment by each change, not by its first value, and as long as it is held") {
    NodeHarness node("button", {.period = flicks_per_second / 1000, .drive_params = false});
    node.set("press", "7");
    node.prepare();
    node.run(50);
    CHECK(std::ranges::count(node.values<bool>("pressed"), true) == 0);
    node.set("press", "8");
    node.run(100);
    CHECK(std::ranges::count(node.values<bool>("pressed"), true) == 20);
    node.set("hold", "1");
    node.run(30);
    CHECK(std::ranges::count(node.values<bool>("pressed"), true) == 50);
    node.set("hold", "0");
    node.run(5);
    CHECK_FALSE(node.last<bool>("pressed"));
}
