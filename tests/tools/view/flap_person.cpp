// SPDX-License-Identifier: Apache-2.0
// A planner with a mouse changes a reconstruction: each change is a step of the plan that the run goes on with.
#include "assets/cases/plan_file.hpp"
#include "assets/reconstruct/reconstruction.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/view/walk.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// As the last run has it; each run in one window has a folder of its own.
reconstruct::Flap flap_of(const fs::path& folder, int run) {
    const fs::path out = folder / (run == 1 ? "out" : fmt::format("out-{}", run));
    return cases::state_of(cases::load_case_plan(out / "case.plan.json")).reconstruction->flap;
}

}  // namespace

TEST_CASE(
    "a planner with a mouse lays a plate, puts an implant where it was measured, removes the plate and undoes that",
    "[display][live]") {
    for (const WalkWindow& window : walk_windows(usual_window)) {
        Walk walk(window, "flap");
        if (!walk.is_possible()) return;
        walk.start(
            "run planning-reconstruction --view --layout plan --set hand.device=mouse --audio none --out out --seconds "
            "280 --json",
            280.0);
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto apply = [&](const std::string& name) {
            REQUIRE(walk.waits_for("name of the part"));
            walk.press("name of the part");
            walk.person.type(name);
            walk.press("apply to the plan");
        };
        // At once: what is measured of the plan meanwhile must not be waited for.
        REQUIRE(walk.waits_for("+ plate"));
        walk.press("+ plate");
        apply("p1");
        REQUIRE(walk.waits_for("plate p1"));
        REQUIRE(flap_of(walk.folder.path, 2).plates.size() == 1);
        CHECK(flap_of(walk.folder.path, 2).plates[0].name == "p1");
        walk.keep("plate");

        // Its head is the first of two measured points, its axis goes to the second.
        REQUIRE(walk.waits_for("part segment-2"));
        walk.person.tap("1");
        Person::wait(2.0);
        walk.measure();
        press("+ implant");
        REQUIRE(walk.waits_for("at the measured point"));
        walk.press("at the measured point");
        apply("i1");
        REQUIRE(walk.waits_for("implant i1"));
        const reconstruct::Flap with = flap_of(walk.folder.path, 3);
        REQUIRE(with.implants.size() == 1);
        CHECK(with.plates.size() == 1);
        CHECK(glm::length(with.implants[0].head) > 1e-3);
        CHECK(std::abs(glm::length(with.implants[0].axis) - 1.0) < 1e-6);
        walk.keep("implant");

        press("remove plate p1");
        REQUIRE(walk.waits_while("plate p1"));
        REQUIRE(walk.waits_for("implant i1"));
        CHECK(flap_of(walk.folder.path, 4).plates.empty());
        press("undo step");
        CHECK(sees([&] { return flap_of(walk.folder.path, 4).plates.size() == 1; }));
        walk.keep("undone");
        walk.stop();
    }
}
