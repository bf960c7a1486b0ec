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

namespace {

/// A broken bar: fragments one and two near their place, and the whole bar.
struct BrokenBar {
    test::Folder folder;
    std::string plan = file("case.plan.json");

    BrokenBar() {
        bone::save_bone(test::bar(), file("bar.vdb"));
        REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 0.2 --turn 0.2")
                    .code == 0);
    }
    std::string file(const std::string& name) const { return (folder.path / name).string(); }
    Outcome run(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
};

}  // namespace

TEST_CASE("a place that a surgeon accepts completes a plan, and is void when a piece moves", "[slow]") {
    const BrokenBar bar;
    REQUIRE(bar.run("new", "one=" + bar.file("f/fragment_01.stl") + " two=" + bar.file("f/fragment_02.stl")).code == 0);
    CHECK_THAT(bar.run("accept", "two --by mirror").err, ContainsSubstring("the plan has no healthy side"));
    CHECK_THAT(bar.run("accept", "two --by plan").err, ContainsSubstring("'two' is no piece of a reconstruction"));
    const Outcome before = bar.run("check");
    CHECK(before.code == 1);
    CHECK_THAT(before.out, ContainsSubstring("in 2 parts that no fit connects"));
    REQUIRE(bar.run("accept", "two --by hand").code == 0);
    const Outcome complete = bar.run("check");
    INFO(complete.out);
    CHECK(complete.code == 0);
    CHECK_THAT(complete.out, !ContainsSubstring("not in contact"));
    const json fit = json::parse(bar.run("show", "--json").out)["fragments"][1]["fit"];
    CHECK(fit["verdict"] == "accepted by hand");
    CHECK(fit["partner"] == "one");
    CHECK(bar.run("undo").code == 0);
    CHECK(bar.run("check").code == 1);
    CHECK(bar.run("redo").code == 0);
    REQUIRE(bar.run("move", "two --pose 1,0,0,1,0,0,0").code == 0);
    const Outcome moved = bar.run("check");
    CHECK(moved.code == 1);
    CHECK_THAT(moved.out, ContainsSubstring("is void: moved 1.00 mm"));
    CHECK_THAT(bar.run("accept", "two --by hand --beside two").err, ContainsSubstring("cannot be its own partner"));
    REQUIRE(bar.run("move", "two --pose 90,0,0,1,0,0,0").code == 0);
    REQUIRE(bar.run("accept", "two --by hand").code == 0);
    CHECK_THAT(bar.run("check").out, ContainsSubstring("warning: two is accepted ") &&
                                         ContainsSubstring(" mm from one: they are not in contact"));
    REQUIRE(bar.run("hide", "one").code == 0);
    CHECK_THAT(bar.run("accept", "two --by hand").err, ContainsSubstring("the only fragment that is shown"));
}

TEST_CASE("only a piece that lies on the healthy side is accepted by it, with its distance", "[slow]") {
    const BrokenBar bar;
    REQUIRE(bar.run("new", "bar=" + bar.file("bar.vdb") + " two=" + bar.file("f/fragment_02.stl")).code == 0);
    REQUIRE(bar.run("mirror", bar.file("bar.vdb") + " bar").code == 0);
    const Outcome accepted = bar.run("accept", "two --by mirror");
    INFO(accepted.out << accepted.err);
    REQUIRE(accepted.code == 0);
    CHECK_THAT(accepted.out, ContainsSubstring("two: accepted by mirror beside bar, residual 0."));
    CHECK_THAT(bar.run("show").out, ContainsSubstring("accepted by mirror, 0."));
    REQUIRE(bar.run("move", "two --pose 0,60,0,1,0,0,0").code == 0);
    CHECK_THAT(bar.run("accept", "two --by mirror").err, ContainsSubstring("more than 2.0 mm"));
}
