// SPDX-License-Identifier: Apache-2.0
// A surgeon's decisions in a plan: recorded with their residual, void when the fragment moves.
#include "assets/bone/bone.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::Outcome;

TEST_CASE("a reduction by the healthy side is complete once it is accepted, and void when a piece moves", "[slow]") {
    const test::Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(test::bar(), file("bar.vdb"));
    REQUIRE(
        folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 0.2 --turn 0.2").code ==
        0);
    const std::string plan = file("case.plan.json");
    const auto run = [&](const std::string& verb, const std::string& rest = "") {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    };
    REQUIRE(run("new", "one=" + file("f/fragment_01.stl") + " two=" + file("f/fragment_02.stl")).code == 0);
    CHECK_THAT(run("accept", "two --by mirror").err, ContainsSubstring("the plan has no healthy side"));
    CHECK_THAT(run("accept", "two --by plan").err, ContainsSubstring("'two' is no piece of a reconstruction"));
    REQUIRE(run("mirror", file("bar.vdb") + " one two").code == 0);
    const Outcome before = run("check");
    CHECK(before.code == 1);
    CHECK_THAT(before.out, ContainsSubstring("in 2 parts that no fit connects"));

    const Outcome accepted = run("accept", "two --by mirror");
    INFO(accepted.out << accepted.err);
    REQUIRE(accepted.code == 0);
    CHECK_THAT(accepted.out, ContainsSubstring("two: accepted by mirror beside one, residual 0."));
    const Outcome complete = run("check");
    INFO(complete.out);
    CHECK(complete.code == 0);
    CHECK_THAT(run("show").out, ContainsSubstring("accepted by mirror, 0."));
    const json fit = json::parse(run("show", "--json").out)["fragments"][1]["fit"];
    CHECK(fit["verdict"] == "accepted by mirror");
    CHECK(fit["partner"] == "one");
    CHECK(fit["rms_mm"].get<double>() < 0.5);
    CHECK(run("undo").code == 0);
    CHECK(run("check").code == 1);

    // Too far from the mirrored side: only the surgeon's eye can accept it, and a move makes that void.
    REQUIRE(run("move", "two --pose 60,0,0,1,0,0,0").code == 0);
    CHECK_THAT(run("accept", "two --by mirror").err, ContainsSubstring("more than 2.0 mm"));
    REQUIRE(run("accept", "two --by hand").code == 0);
    CHECK(run("check").code == 0);
    REQUIRE(run("move", "two --pose 61,0,0,1,0,0,0").code == 0);
    const Outcome moved = run("check");
    CHECK(moved.code == 1);
    CHECK_THAT(moved.out, ContainsSubstring("is void: moved 1.00 mm"));
    CHECK_THAT(run("accept", "two --by hand --beside two").err, ContainsSubstring("cannot be its own partner"));
    REQUIRE(run("hide", "one").code == 0);
    CHECK_THAT(run("accept", "two --by hand").err, ContainsSubstring("the only fragment that is shown"));
}
