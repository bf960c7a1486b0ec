// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

using namespace tactus;
using test::NodeHarness;

TEST_CASE("every pose goes to the sender, which sends the newest") {
    NodeHarness node("openigtlink_output");
    node.feed<Pose>("pose",
                    [](std::int64_t k) { return Pose{{static_cast<double>(k), 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}; });
    node.prepare();
    node.run(100);
    const test::MemoryStream& stream = *node.host.records.at(0);
    CHECK(stream.gapless);
    CHECK(stream.format.keeper);
    CHECK(stream.values<Pose>().size() == 100);
    CHECK(stream.values<Pose>()[42].position.x == 42.0);
}
