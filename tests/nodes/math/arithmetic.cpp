// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <cmath>
#include <limits>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// What a node with the inputs a and b gives for two numbers.
double of_numbers(const char* type, double a, double b) {
    NodeHarness node(type, {.period = ms});
    node.feed("a", a).feed("b", b);
    node.prepare();
    node.run(1);
    return node.last<double>("out");
}

std::vector<float> of_signals(const char* type) {
    NodeHarness node(type, {.any = &value::signal});
    node.feed<float>("a", [](std::int64_t k) { return static_cast<float>(k); });
    node.feed<float>("b", [](std::int64_t k) { return 2.0f - static_cast<float>(k); });
    node.prepare();
    node.run(5);
    return node.values<float>("out");
}

double of_number(NodeHarness& node, double in) {
    node.feed("in", in);
    node.prepare();
    node.run(1);
    return node.last<double>("out");
}

}  // namespace

TEST_CASE("arithmetic on numbers follows its formula") {
    CHECK(of_numbers("add", 2.5, -4.0) == -1.5);
    CHECK(of_numbers("subtract", 2.5, -4.0) == 6.5);
    CHECK(of_numbers("multiply", 2.5, -4.0) == -10.0);
    CHECK(of_numbers("divide", 2.5, -4.0) == -0.625);
    CHECK(of_numbers("divide", 2.5, 0.0) == 0.0);
    CHECK(of_numbers("minimum", 2.5, -4.0) == -4.0);
    CHECK(of_numbers("maximum", 2.5, -4.0) == 2.5);
}

TEST_CASE("arithmetic on signals is done sample by sample") {
    CHECK(of_signals("add") == std::vector<float>{2.0f, 2.0f, 2.0f, 2.0f, 2.0f});
    CHECK(of_signals("subtract") == std::vector<float>{-2.0f, 0.0f, 2.0f, 4.0f, 6.0f});
    CHECK(of_signals("multiply") == std::vector<float>{0.0f, 1.0f, 0.0f, -3.0f, -8.0f});
    CHECK(of_signals("divide") == std::vector<float>{0.0f, 1.0f, 0.0f, -3.0f, -2.0f});
    CHECK(of_signals("maximum") == std::vector<float>{2.0f, 1.0f, 2.0f, 3.0f, 4.0f});
}

TEST_CASE("two forces are added, and so are vectors and twists, component by component") {
    NodeHarness wrenches("add", {.period = ms, .any = &value::wrench});
    wrenches.feed("a", Wrench{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}})
        .feed("b", Wrench{{10.0, 20.0, 30.0}, {-4.0, 0.5, 1.0}});
    wrenches.prepare();
    wrenches.run(1);
    const Wrench sum = wrenches.last<Wrench>("out");
    CHECK(sum.force == Vec3(11.0, 22.0, 33.0));
    CHECK(sum.torque == Vec3(0.0, 5.5, 7.0));
    NodeHarness vectors("subtract", {.period = ms, .any = &value::vector});
    vectors.feed("a", Vec3(1.0, 2.0, 3.0)).feed("b", Vec3(0.5, 4.0, -1.0));
    vectors.prepare();
    vectors.run(1);
    CHECK(vectors.last<Vec3>("out") == Vec3(0.5, -2.0, 4.0));
    NodeHarness twist("negate", {.period = ms, .any = &value::twist});
    twist.feed("in", Twist{{1.0, -2.0, 3.0}, {0.0, 5.0, -6.0}});
    twist.prepare();
    twist.run(1);
    CHECK(twist.last<Twist>("out").linear == Vec3(-1.0, 2.0, -3.0));
    CHECK(twist.last<Twist>("out").angular == Vec3(0.0, -5.0, 6.0));
}

TEST_CASE("absolute, clip and wrap of a number") {
    NodeHarness absolute("absolute", {.period = ms});
    CHECK(of_number(absolute, -2.5) == 2.5);
    for (const auto& [in, out] : {std::pair{0.5, 0.5}, {-3.0, -2.0}, {9.0, 4.0}, {not_a_number, -2.0}}) {
        NodeHarness clip("clip", {.period = ms});
        clip.set("low", "-2").set("high", "4");
        CHECK(of_number(clip, in) == out);
    }
    NodeHarness crossed("clip", {.period = ms});
    crossed.set("low", "5").set("high", "1");
    CHECK(of_number(crossed, 3.0) == 1.0);
    for (const auto& [in, out] : {std::pair{1.0, 1.0}, {3.0, -1.0}, {-1.5, 2.5}, {-5.5, 2.5}, {not_a_number, -1.0}}) {
        NodeHarness wrap("wrap", {.period = ms});
        wrap.set("low", "-1").set("high", "3");
        CHECK(of_number(wrap, in) == Approx(out));
    }
    // What rounding brings to the end of the range is at its beginning.
    NodeHarness rounded("wrap", {.period = ms});
    const double just_below = of_number(rounded, -1e-18);
    CHECK(just_below >= 0.0);
    CHECK(just_below < 1.0);
}

TEST_CASE("a curve goes through its points by straight lines and is level outside") {
    for (const auto& [in, out] : {std::pair{-5.0, 2.0},
                                  {0.0, 2.0},
                                  {0.5, 3.0},
                                  {1.0, 4.0},
                                  {2.0, 1.0},
                                  {3.0, -2.0},
                                  {9.0, -2.0},
                                  {not_a_number, 2.0}}) {
        NodeHarness curve("curve", {.period = ms});
        curve.set("points", "0 2, 1 4, 3 -2");
        CHECK(of_number(curve, in) == Approx(out));
    }
    for (const char* wrong : {"", "1", "0 0, 1 x", "1 0, 0 1", "0 0,, 1 1", "0 0 0", "0 inf"}) {
        NodeHarness curve("curve", {.period = ms});
        curve.set("points", wrong);
        INFO(wrong);
        CHECK_THROWS_AS(curve.prepare(), Error);
    }
}

TEST_CASE("a bool becomes one of two numbers, a number a signal, a signal a number") {
    for (const bool in : {true, false}) {
        NodeHarness node("to_number", {.period = ms, .any = &value::boolean});
        node.set("if_true", "5").set("if_false", "-2").feed("in", in);
        node.prepare();
        node.run(1);
        CHECK(node.last<double>("out") == (in ? 5.0 : -2.0));
    }
    NodeHarness number("to_signal");
    number.feed<double>("in", [](std::int64_t k) { return 0.5 * static_cast<double>(k); });
    number.prepare();
    number.run(4);
    CHECK(number.values<float>("out") == std::vector<float>{0.0f, 0.5f, 1.0f, 1.5f});
    NodeHarness signal("to_number", {.any = &value::signal});
    signal.feed<float>("in", [](std::int64_t k) { return 0.25f * static_cast<float>(k); });
    signal.prepare();
    signal.run(4);
    CHECK(signal.values<double>("out") == std::vector<double>{0.0, 0.25, 0.5, 0.75});
}
