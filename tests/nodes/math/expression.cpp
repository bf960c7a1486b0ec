// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/stiffness.hpp"
#include "graph/compile/compile.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::NodeHarness;

namespace {

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

/// A hand that feels `law`, which is more TOML of the node; its in1 is a position, its in2 a speed.
compile::Schedule felt(const std::string& law, const std::string& more_wires = "") {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(
        "wires = [\"hand.pose -> place.in\", \"place.position -> where.in\", \"where.z -> law.in1\",\n"
        "\"law.out -> up.z\", \"up.out -> push.force\", \"push.out -> out.wrench\"" +
            more_wires +
            "]\n[nodes]\nhand = { type = \"device_input\", rate = \"1 kHz\" }\n"
            "place = { type = \"split_pose\", rate = \"1 kHz\" }\n"
            "where = { type = \"split_vector\", rate = \"1 kHz\" }\n" +
            (more_wires.empty() ? ""
                                : "motion = { type = \"split_twist\", rate = \"1 kHz\" }\n"
                                  "speed = { type = \"split_vector\", rate = \"1 kHz\" }\n") +
            "up = { type = \"join_vector\", rate = \"1 kHz\" }\npush = { type = \"join_wrench\", rate = \"1 kHz\" }\n"
            "out = { type = \"device_output\", rate = \"1 kHz\" }\n"
            "law = { type = \"expression\", rate = \"1 kHz\", unit = \"N\", " +
            law + " }\n",
        "p.toml", problems);
    std::optional<compile::Schedule> plan;
    if (problems.empty()) plan = compile::compile(patch, nodes::catalogue(), problems);
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(plan);
    return std::move(*plan);
}

std::vector<analyse::ForceLoop> loops_of(const compile::Schedule& plan) {
    return analyse::force_loops(plan, [](const std::string&) { return DeviceInfo{.name = {}, .damping = 1.0}; });
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
    CHECK_THAT(refusal("2*x", "x m", ""), ContainsSubstring("the formula gives m, but 'unit' is a number"));
    CHECK_THAT(refusal("2*x", "x m", "N"), ContainsSubstring("the formula gives m, but 'unit' is N"));
    CHECK_THAT(refusal("x + y", "x m, y m"), ContainsSubstring("'y' needs a wire to 'in2'"));
    CHECK(refusal("x", "x m, y m") == "accepted");
    CHECK_THAT(refusal("x +", "x m"), ContainsSubstring("ends too early"));
    CHECK_THAT(refusal("x", ""), ContainsSubstring("one to six inputs"));
    CHECK_THAT(refusal("x", "x m, y, a, b, c, d, e"), ContainsSubstring("one to six inputs"));
}

TEST_CASE("the slope of a formula on the way to the hand is a stiffness that check judges") {
    const std::string speeds = ", \"hand.twist -> motion.in\", \"motion.linear -> speed.in\", \"speed.z -> law.in2\"";
    const compile::Schedule wall = felt(
        "inputs = \"z m, v m/s\", constants = \"k = 2.5 N/mm, c = 2 N s/m\", formula = \"k * max(0 m, -z) - c * v\"",
        speeds);
    CHECK(analyse::unstated_laws(wall).empty());
    REQUIRE(loops_of(wall).size() == 1);
    REQUIRE(loops_of(wall)[0].declared);
    CHECK(loops_of(wall)[0].declared->param == "law (its slope)");
    CHECK(loops_of(wall)[0].declared->newton_per_metre == Approx(2500.0));
    // 1 N·s/m bears 2000 N/m at 1 kHz.
    CHECK(loops_of(wall)[0].verdict() == analyse::Verdict::too_stiff);

    const compile::Schedule jump =
        felt("inputs = \"z m, v m/s\", constants = \"k = 1 N/m\", formula = \"if(z < 0 m, -k * z, 0 N)\"", speeds);
    CHECK(analyse::unstated_laws(jump) == std::vector<std::string>{"law"});
    CHECK_FALSE(loops_of(jump)[0].declared);

    const std::string hertz = "constants = \"k = 4 N/m^1.5\", formula = \"k * max(0 m, -z)^1.5\", inputs = \"z m";
    CHECK(analyse::unstated_laws(felt(hertz + "\"")).size() == 1);
    const compile::Schedule within = felt(hertz + " from -1 m to 0 m\"");
    CHECK(analyse::unstated_laws(within).empty());
    CHECK(loops_of(within)[0].declared->newton_per_metre == Approx(6.0));
}

TEST_CASE("the slope of a curve is judged by what its force goes to") {
    compile::Schedule plan = felt("inputs = \"z m\", formula = \"z * (1 N/m)\"");
    CHECK(loops_of(plan)[0].declared->newton_per_metre == Approx(1.0));
    const std::string curve =
        "wires = [\"hand.pose -> place.in\", \"place.position -> where.in\", \"where.z -> law.in\",\n"
        "\"law.out -> up.z\", \"up.out -> push.force\", \"push.out -> out.wrench\"]\n"
        "[nodes]\nhand = { type = \"device_input\", rate = \"1 kHz\" }\n"
        "place = { type = \"split_pose\", rate = \"1 kHz\" }\n"
        "where = { type = \"split_vector\", rate = \"1 kHz\" }\n"
        "up = { type = \"join_vector\", rate = \"1 kHz\" }\n"
        "push = { type = \"join_wrench\", rate = \"1 kHz\" }\n"
        "out = { type = \"device_output\", rate = \"1 kHz\" }\n"
        "law = { type = \"curve\", rate = \"1 kHz\", points = \"-1 0, 0 0, 1e-3 3, 2e-3 2\" }\n";
    patch::Problems problems;
    const auto made = compile::compile(patch::read_patch(curve, "p.toml", problems), nodes::catalogue(), problems);
    REQUIRE(made);
    CHECK(analyse::unstated_laws(*made).empty());
    CHECK(loops_of(*made)[0].declared->newton_per_metre == Approx(3000.0));
}

TEST_CASE("an input with a range is clamped to it, so that the slope beyond is not felt") {
    NodeHarness node("expression", {.period = ms});
    node.disconnect_optional().set("formula", "x^2").set("inputs", "x from -1 to 2");
    node.feed<double>("in1", [](std::int64_t k) {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        return std::vector<double>{0.5, 3.0, -7.0, std::nan(""), infinite}[static_cast<std::size_t>(k)];
    });
    node.prepare();
    node.run(5);
    CHECK(node.values<double>("out") == std::vector<double>{0.25, 4.0, 1.0, 0.0, 4.0});
    NodeHarness sound("expression", {.any = &value::signal});
    sound.disconnect_optional().set("formula", "x").set("inputs", "x from -0.5 to 0.5").feed("in1", 3.0f);
    sound.prepare();
    sound.run(100);
    CHECK(sound.last<float>("out") == 0.5f);
}
