// SPDX-License-Identifier: Apache-2.0
// A planner with a mouse changes a reconstruction: each change is a step of the plan that the run goes on with.
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/walk.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// Each run in one window has a folder of its own.
fs::path plan_of(const fs::path& folder, int run) {
    return folder / (run == 1 ? "out" : fmt::format("out-{}", run)) / "case.plan.json";
}

/// As that run has it.
reconstruction::Flap flap_of(const fs::path& folder, int run) {
    return plan::state_of(plan::load_case_plan(plan_of(folder, run))).reconstruction->flap;
}

}  // namespace

TEST_CASE(
    "a planner with a mouse lays a plate, puts an implant where it was measured, removes the plate and undoes that",
    "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "flap");
        if (!walk.is_possible()) return;
        walk.start(
            "run planning-reconstruction --view --layout plan --set hand.device=mouse --audio none --out out --seconds "
            "280 --json",
            280.0);
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto begins = [&](int run) { return sees([&] { return fs::exists(plan_of(walk.folder.path, run)); }); };
        const auto apply = [&](const std::string& name) {
            REQUIRE(walk.waits_for("name of the part"));
            walk.press("name of the part");
            walk.person.type(name);
            walk.press("apply to the plan");
        };
        // At once: what is measured of the plan meanwhile must not be waited for.
        REQUIRE(walk.waits_for("+ plate", "panel plan steps"));
        press("+ plate");
        apply("p1");
        REQUIRE(begins(2));
        REQUIRE(walk.waits_for("plate p1", "panel plan steps"));
        REQUIRE(flap_of(walk.folder.path, 2).plates.size() == 1);
        CHECK(flap_of(walk.folder.path, 2).plates[0].name == "p1");
        walk.keep("plate");

        // Its head is the first of two measured points, its axis goes to the second.
        REQUIRE(walk.waits_for("part segment-2", "panel tree"));
        walk.person.tap("1");
        Person::wait(2.0);
        walk.measure();
        press("+ implant");
        REQUIRE(walk.waits_for("at the measured point"));
        walk.press("at the measured point");
        apply("i1");
        REQUIRE(begins(3));
        REQUIRE(walk.waits_for("implant i1", "panel plan steps"));
        const reconstruction::Flap with = flap_of(walk.folder.path, 3);
        REQUIRE(with.implants.size() == 1);
        CHECK(with.plates.size() == 1);
        CHECK(glm::length(with.implants[0].head) > 1e-3);
        CHECK(std::abs(glm::length(with.implants[0].axis) - 1.0) < 1e-6);
        walk.keep("implant");

        press("remove plate p1");
        REQUIRE(begins(4));
        REQUIRE(walk.waits_while("plate p1"));
        REQUIRE(walk.waits_for("implant i1", "panel plan steps"));
        CHECK(flap_of(walk.folder.path, 4).plates.empty());
        press("undo step");
        CHECK(sees([&] { return flap_of(walk.folder.path, 4).plates.size() == 1; }));
        walk.keep("undone");
        walk.stop();
    }
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a planner with a mouse adds a vessel, a site and a margin, and a plate keeps how it was laid", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "forms");
        if (!walk.is_possible()) return;
        walk.start(
            "run planning-reconstruction --view --layout plan --set hand.device=mouse --audio none --out out --seconds "
            "400 --json",
            400.0);
        // While a change is made no form opens.
        const auto opens = [&](const std::string& control, const std::string& field) {
            REQUIRE(walk.waits_for(control, "panel plan steps"));
            REQUIRE(walk.until([&] { return walk.shows(field); }, [&] { walk.press(control, "panel plan steps"); }));
        };
        int run = 1;
        const auto apply = [&] {
            walk.press("apply to the plan");
            ++run;
            const bool has_begun = sees([&] { return fs::exists(plan_of(walk.folder.path, run)); });
            if (!has_begun) walk.keep("not-applied");
            REQUIRE(has_begun);
        };
        const auto type_into = [&](const std::string& control, const std::string& text) {
            walk.press(control);
            walk.person.type(text);
        };
        const auto slide_to = [&](const std::string& control, const std::string& number) {
            walk.person.key("Control_L", true);
            walk.press(control);
            walk.person.key("Control_L", false);
            walk.person.type(number);
            walk.person.tap("Return");
            Person::wait(0.5);
        };
        opens("+ plate", "name of the part");
        type_into("name of the part", "p1");
        slide_to("screws of the plate", "3");
        slide_to("height of the plate", "-2.5");
        walk.keep("plate");
        apply();
        const reconstruction::Plate laid = flap_of(walk.folder.path, run).plates.at(0);
        REQUIRE(laid.laid);
        CHECK(laid.laid->screws_per_segment == 3);
        CHECK(laid.laid->height == Approx(-2.5e-3));
        REQUIRE(walk.waits_for("part plate p1", "panel tree"));

        // Opened and applied as it is, it stays as it is.
        opens("plate p1", "apply to the plan");
        walk.keep("plate-again");
        apply();
        const reconstruction::Plate again = flap_of(walk.folder.path, run).plates.at(0);
        CHECK(again.points == laid.points);
        CHECK(again.screws.size() == laid.screws.size());

        opens("margin...", "margin of the tumour");
        slide_to("margin of the tumour", "7");
        apply();
        CHECK(flap_of(walk.folder.path, run).margin == Approx(7e-3));

        const std::size_t vessels = flap_of(walk.folder.path, run).vessels.size();
        opens("+ vessel", "name of the part");
        type_into("name of the part", "second");
        fs::copy(library_folder() / "cases/fibula-flap/vein.csv", walk.folder.path / "vein.csv");
        type_into("file of the vessel", "vein.csv");
        walk.keep("vessel");
        apply();
        REQUIRE(flap_of(walk.folder.path, run).vessels.size() == vessels + 1);
        CHECK(flap_of(walk.folder.path, run).vessels.back().name == "second");

        opens("+ site", "name of the part");
        type_into("name of the part", "lingual");
        apply();
        CHECK(flap_of(walk.folder.path, run).sites.back().name == "lingual");
        walk.keep("site");
        walk.stop();
    }
}
