// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::NodeHarness;

namespace {

constexpr Flicks ms = flicks_per_second / 1000;

std::string refusal(const char* formula, const char* inputs = "x m", const char* unit = "m") {
    NodeHarness node("expression", {.period = ms});
    node.disconnect_optional();
    node.set("formula", formula).set("inputs", inputs).set("unit", unit);
    try {
        node.prepare();
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("an expression is a virtual wall: no force outside, a Hertz contact with damping within") {
    NodeHarness node("expression", {.period = ms});
    node.disconnect_optional().connect("in2");
    node.set("formula", "if(x > 0 m, k * x^1.5 + c * v, 0 N)").set("inputs", "x m, v m/s").set("unit", "N");
    node.set("constants", "k = 30 N/mm^1.5, c = 2 N s/m");
    const auto depth = [](std::int64_t k) { return 1e-3 * std::sin(0.01 * static_cast<double>(k)); };
    node.feed<double>("in1", depth).feed("in2", 0.05);
    node.prepare();
    node.run(1000);
    const auto force = node.values<double>("out");
    for (std::int64_t k = 0; k < 1000; ++k) {
        const double x = depth(k);
        CHECK(force[static_cast<std::size_t>(k)] ==
              Approx(x > 0.0 ? 30.0 * std::pow(1e3 * x, 1.5) + 0.1 : 0.0).margin(1e-12));
    }
}

TEST_CASE("an expression of signals is computed sample by sample, beyond one block of its machine too") {
    NodeHarness node("expression", {.max_frames = 200, .any = &value::signal});
    node.set("formula", "clip(2*x - y, -1, 1)");
    node.feed<float>("in1", [](std::int64_t k) { return 0.01f * static_cast<float>(k % 97); });
    node.feed<float>("in2", [](std::int64_t k) { return 0.02f * static_cast<float>(k % 31); });
    node.prepare();
    node.run(1000);
    const auto out = node.values<float>("out");
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double x = static_cast<double>(0.01f * static_cast<float>(k % 97));
        const double y = static_cast<double>(0.02f * static_cast<float>(k % 31));
        CHECK(out[k] == static_cast<float>(std::clamp(2.0 * x - y, -1.0, 1.0)));
    }
}

TEST_CASE("a result that is not finite gives 0") {
    NodeHarness node("expression", {.period = ms});
    node.set("formula", "1/x + log(y)").feed("in1", 0.0).feed("in2", -1.0);
    node.prepare();
    node.run(1);
    CHECK(node.last<double>("out") == 0.0);
}

TEST_CASE("an expression says what is missing") {
    CHECK(refusal("2*x") == "accepted");
    CHECK_THAT(refusal("2*x", "x m", ""), ContainsSubstring("the formula gives m, but 'unit' says a number"));
    CHECK_THAT(refusal("2*x", "x m", "N"), ContainsSubstring("the formula gives m, but 'unit' says N"));
    CHECK_THAT(refusal("x + y", "x m, y m"), ContainsSubstring("'y' needs a wire to 'in2'"));
    CHECK(refusal("x", "x m, y m") == "accepted");
    CHECK_THAT(refusal("x +", "x m"), ContainsSubstring("ends too early"));
    CHECK_THAT(refusal("x", ""), ContainsSubstring("one to six inputs"));
    CHECK_THAT(refusal("x", "x m, y, a, b, c, d, e"), ContainsSubstring("one to six inputs"));
}
