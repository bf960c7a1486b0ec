// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/stiffness.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

using namespace tactus;

namespace {

std::vector<analyse::ForceLoop> loops_of(const std::string& text, double damping = 2.0) {
    const Compiled c = compiled(text);
    INFO(c.said);
    REQUIRE(c.plan);
    return analyse::force_loops(*c.plan,
                                [damping](const std::string&) { return DeviceInfo{.name = {}, .damping = damping}; });
}

const std::string hand = a_node("in", "device_input") + a_node("out", "device_output");

}  // namespace

TEST_CASE("the largest stiffness is damping over half a period and the delay") {
    // b / (T (1/2 + D)) for b = 2 N s/m at 1 kHz: 4, 1.33 and 0.8 N/mm for no, one and two periods of delay.
    CHECK(analyse::stiffness_limit(2.0, 1e-3, 0.0) == Approx(4000.0));
    CHECK(analyse::stiffness_limit(2.0, 1e-3, 1e-3) == Approx(1333.333));
    CHECK(analyse::stiffness_limit(2.0, 1e-3, 2e-3) == Approx(800.0));
}

//  in ──► wall ──► out     all at 1 kHz
TEST_CASE("a spring in the tick of the hand is compared with the limit of no delay") {
    const auto loops = loops_of("wires = [\"in.out -> wall.in\", \"wall.out -> out.in\"]\n" + hand +
                                a_node("wall", "stiff", "1 kHz", "stiffness = \"3.9 N/mm\"\n"));
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].limit == Approx(4000.0));
    REQUIRE(loops[0].declared);
    CHECK(loops[0].declared->param == "wall.stiffness");
    CHECK(loops[0].declared->newton_per_metre == Approx(3900.0));
    CHECK(loops[0].ok());
}

//  in ──► wall ─1─► out
TEST_CASE("one tick of delay costs a factor of three") {
    const auto loops = loops_of("wires = [\"in.out -> wall.in\", \"wall.out -> out.in as delay 1\"]\n" + hand +
                                a_node("wall", "stiff", "1 kHz", "stiffness = \"3.9 N/mm\"\n"));
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].latency_s == Approx(1e-3));
    CHECK(loops[0].limit == Approx(4000.0 / 3.0));
    CHECK_FALSE(loops[0].ok());
}

//  in ──► soft ─────────► x.a ──► out
//   └───► wall (100 Hz) ► x.b
TEST_CASE("of several springs the one nearest to its limit counts, with its own way's latency") {
    const auto loops = loops_of(
        "wires = [\"in.out -> soft.in\", \"in.out -> wall.in\", \"soft.out -> x.a\", \"wall.out -> x.b\", "
        "\"x.out -> out.in\"]\n" +
        hand + a_node("soft", "stiff", "1 kHz", "stiffness = \"0.5 N/mm\"\n") +
        a_node("wall", "stiff", "100 Hz", "stiffness = \"0.2 N/mm\"\n") + a_node("x", "sum"));
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].declared->param == "wall.stiffness");
    CHECK(loops[0].latency_s == Approx(20e-3));  // 1 ms down, 10 ms of the slow group and 9 ms until it is read
    CHECK(loops[0].limit == Approx(2.0 / (0.5e-3 + 20e-3)));
    CHECK_FALSE(loops[0].ok());
}

TEST_CASE("a driven stiffness counts with the end of its range") {
    const auto loops =
        loops_of("wires = [\"in.out -> wall.in\", \"wall.out -> out.in\", \"s.value -> wall.stiffness\"]\n" + hand +
                 a_node("wall", "stiff") + a_node("s", "source"));
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].declared->newton_per_metre == Approx(20e3));
    CHECK_FALSE(loops[0].ok());
}

TEST_CASE("a path without a spring has a limit and nothing to compare, and on an unknown device the hand alone damps") {
    const auto plain = loops_of("wires = [\"in.out -> out.in\"]\n" + hand);
    REQUIRE(plain.size() == 1);
    CHECK_FALSE(plain[0].declared);
    CHECK(plain[0].limit == Approx(4000.0));
    CHECK(plain[0].ok());
    CHECK(loops_of("wires = [\"in.out -> out.in\"]\n" + hand, 0.0)[0].limit == Approx(4000.0));
}

TEST_CASE("a stiffness beyond what a hand alone damps is unknown on a device that states no damping") {
    const auto wall = [](const std::string& stiffness) {
        return "wires = [\"in.out -> wall.in\", \"wall.out -> out.in\"]\n" + hand +
               a_node("wall", "stiff", "1 kHz", "stiffness = \"" + stiffness + "\"\n");
    };
    CHECK(loops_of(wall("3.9 N/mm"), 2.0)[0].verdict() == analyse::Verdict::stable);
    CHECK(loops_of(wall("3.9 N/mm"), 1.0)[0].verdict() == analyse::Verdict::too_stiff);
    CHECK(loops_of(wall("3.9 N/mm"), 0.0)[0].verdict() == analyse::Verdict::stable);
    CHECK(loops_of(wall("4.1 N/mm"), 0.0)[0].verdict() == analyse::Verdict::unknown);
    CHECK_FALSE(loops_of(wall("4.1 N/mm"), 0.0)[0].ok());
}

TEST_CASE("the delay of the device counts in the loop, half of it at each end") {
    Compiled c = compiled("wires = [\"in.out -> wall.in\", \"wall.out -> out.in\"]\n" + hand + a_node("wall", "stiff"));
    INFO(c.said);
    REQUIRE(c.plan);
    // The nodes of this catalogue have no option 'device'.
    for (patch::PatchNode& node : c.plan->patch.nodes)
        if (node.name != "wall") node.settings.push_back({"device", node.name == "in" ? "left" : "right", {}, {}});
    const auto loops = analyse::force_loops(*c.plan, [](const std::string& name) {
        return DeviceInfo{.name = name, .damping = 3.5, .delay = name == "left" ? 0.5e-3 : 1.5e-3};
    });
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].latency_s == Approx(1e-3));
    CHECK(loops[0].limit == Approx(3.5 / 1.5e-3));
    // A Touch with its tick of the servo loop: 0.07 N/mm without a hand on it.
    CHECK(analyse::stiffness_limit(0.1, 1e-3, 1e-3) == Approx(66.7).epsilon(0.01));
    CHECK(analyse::damping_with_hand(DeviceInfo{}) == 2.0);
}

TEST_CASE("a stiffness beyond what the device states is too stiff, whatever its damping") {
    const Compiled c = compiled("wires = [\"in.out -> wall.in\", \"wall.out -> out.in\"]\n" + hand +
                                a_node("wall", "stiff", "1 kHz", "stiffness = \"3.9 N/mm\"\n"));
    REQUIRE(c.plan);
    for (const double damping : {0.0, 100.0}) {
        const auto verdict = [&](double stated) {
            return analyse::force_loops(*c.plan,
                                        [&](const std::string&) {
                                            return DeviceInfo{.name = {}, .damping = damping, .max_stiffness = stated};
                                        })[0]
                .verdict();
        };
        CHECK(verdict(3800.0) == analyse::Verdict::too_stiff);
        CHECK(verdict(3900.0) != analyse::Verdict::too_stiff);
    }
    const auto felt = analyse::felt_springs(*c.plan);
    REQUIRE(felt.size() == 1);
    CHECK(felt[0].name == "wall.stiffness");
    CHECK(felt[0].param->value == Approx(3900.0));
    CHECK_FALSE(felt[0].is_driven);
}

//  in ──► law ──► out     other stands beside the path
TEST_CASE("a node on the way to the hand whose law no parameter states is named") {
    const Compiled c = compiled("wires = [\"in.out -> law.a\", \"law.out -> out.in\", \"in.out -> other.a\"]\n" + hand +
                                a_node("law", "pair") + a_node("other", "pair"));
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(analyse::unstated_laws(*c.plan) == std::vector<std::string>{"law"});
}
