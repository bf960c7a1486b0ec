// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

using namespace tactus;
using test::NodeHarness;

namespace {

double ranged(double in, const char* in_low, const char* in_high) {
    NodeHarness node("range", {.period = flicks_per_second / 1000});
    node.set("in_low", in_low).set("in_high", in_high).set("out_low", "100").set("out_high", "200").feed("in", in);
    node.prepare();
    node.run(1);
    return node.last<double>("out");
}

double magnitude(const char* part) {
    NodeHarness node("magnitude", {.period = flicks_per_second / 1000, .any = &value::wrench});
    node.set("part", part).feed("in", Wrench{{3.0, 0.0, -4.0}, {0.0, 0.5, 1.2}});
    node.prepare();
    node.run(1);
    return node.last<double>("out");
}

}  // namespace

TEST_CASE("range is a straight line between its ends and constant outside, rising or falling") {
    CHECK(ranged(2.5, "0", "10") == Approx(125.0));
    CHECK(ranged(-1.0, "0", "10") == 100.0);
    CHECK(ranged(11.0, "0", "10") == 200.0);
    CHECK(ranged(2.5, "10", "0") == Approx(175.0));
    CHECK(ranged(4.0, "5", "5") == 100.0);
    CHECK(ranged(5.0, "5", "5") == 200.0);
}

TEST_CASE("magnitude is the length of the force or of the torque") {
    CHECK(magnitude("linear") == Approx(5.0));
    CHECK(magnitude("angular") == Approx(1.3));
}

TEST_CASE("magnitude refuses a wire without the part that is asked for") {
    NodeHarness node("magnitude", {.any = &value::number});
    node.set("part", "angular");
    CHECK_THROWS_AS(node.prepare(), Error);
}

TEST_CASE("a wrapped signal stays below the end of its range as a float too") {
    NodeHarness node("wrap", {.any = &value::signal});
    node.feed<float>("in", [](std::int64_t k) { return -1e-12f * static_cast<float>(k); });
    node.prepare();
    node.run(100);
    for (const float x : node.values<float>("out")) CHECK((x >= 0.0f && x < 1.0f));
}

TEST_CASE("a quotient that is too large for a number is 0") {
    NodeHarness node("divide", {.period = flicks_per_second / 1000});
    node.feed("a", 1.0).feed("b", 1e-320);
    node.prepare();
    node.run(1);
    CHECK(node.last<double>("out") == 0.0);
}
