// SPDX-License-Identifier: Apache-2.0
// A planner puts a broken hip together with the mouse alone: places, snaps, accepts, groups, undoes, saves, and finds all of
// it again, also after a crash.
#include "assets/bone/bone.hpp"
#include "assets/plan/plan_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/made_hip.hpp"
#include "tests/tools/window/walk.hpp"

#include <glm/geometric.hpp>

#include <string>
#include <tuple>
#include <utility>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// A plan of three fragments of the made hip, each moved, with the unbroken bone mirrored as the healthy side.
fs::path broken_hip(const Folder& folder) {
    const auto file = [&](const std::string& name) { return (folder.path / name).string(); };
    const auto run = [&](const std::string& arguments) {
        const Outcome made = folder.tactus(arguments);
        INFO(arguments << "\n" << made.out << made.err);
        REQUIRE(made.code == 0);
    };
    bone::save_bone(made_hip(), file("hip.vdb"));
    run("fracture " + file("hip.vdb") + " -o " + file("pieces") +
        " --pieces 3 --seed 2 --spread 45 --turn 8 --voxel 1.2 --points 1.4");
    run("plan new " + file("hip.plan.json") + " " + file("pieces/fragment_01.vdb") + " " +
        file("pieces/fragment_02.vdb") + " " + file("pieces/fragment_03.vdb"));
    run("plan lock " + file("hip.plan.json") + " fragment_01");
    run("plan mirror " + file("hip.plan.json") + " " + file("hip.vdb") + " fragment_01 --same-side");
    return folder.path / "hip.plan.json";
}

}  // namespace

TEST_CASE("a planner puts a made hip together with the mouse, and finds it unchanged, also after kill -9",
          "[display][live][long]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "hip");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        const fs::path file = broken_hip(walk.folder);
        const auto kept = walk.folder.path / "hip.plan.unsaved.json";
        const auto saved = [&] { return plan::load_case_plan(file); };
        const std::size_t steps = saved().steps.size();
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto save = [&] { person.chord({"Control_L"}, "s"); };
        const auto has_steps = [&](std::size_t count) {
            return walk.until([&] { return saved().steps.size() == count; }, save);
        };
        const auto waits_for_end = [&](const std::string& of) {
            Person::wait(1.0);
            for (int n = 0; n < 8; ++n)
                if (walk.waits_while(of)) return true;
            return false;
        };
        const auto middle = [&](const std::string& name) {
            const Spot at = walk.eyes.resting_spot(name);
            return std::pair(0.5 * (at.left + at.right), 0.5 * (at.top + at.bottom));
        };
        const auto choose = [&](const std::string& name) {
            walk.press("part " + name, "panel tree");
            REQUIRE(walk.waits_for("handle z"));
        };

        walk.start("view hip.plan.json --layout plan", 900.0);
        REQUIRE(walk.waits_for("part fragment_03", "panel tree"));
        REQUIRE(walk.waits_while("bones are loaded"));
        Person::wait(3.0);
        person.tap("1");
        Person::wait(2.0);
        walk.keep("opened");

        // Measured, and kept beside the plan without a run.
        walk.measure();
        walk.press("keep measurement", "panel tree");
        walk.press("save for Slicer", "panel tree");
        CHECK(sees([&] { return fs::exists(walk.folder.path / "measurements-1.mrk.json"); }));
        walk.press("measure");

        // Placed: by the fragment itself, then on the healthy side.
        choose("fragment_02");
        auto [x, y] = middle("handle z");
        const double before = plan::state_of(saved()).arrangement.pose(1).position.z;
        person.drag(x, y, x, y - 40.0, 1.0);
        REQUIRE(has_steps(steps + 1));
        CHECK(plan::state_of(saved()).arrangement.pose(1).position.z - before > 3e-3);
        walk.keep("dragged");
        press("to the mirror");
        REQUIRE(waits_for_end("place is measured"));
        REQUIRE(has_steps(steps + 2));
        walk.keep("mirrored");
        CHECK(saved().steps.back().fragments == std::vector<int>{1});
        CHECK_FALSE(saved().steps.back().fit);

        // Accepted: a decision without a fit of faces.
        press("accept");
        REQUIRE(waits_for_end("place is measured"));
        REQUIRE(has_steps(steps + 3));
        const plan::PlanStep accepted = saved().steps.back();
        REQUIRE(accepted.fit);
        CHECK(accepted.fit->verdict == "accepted by hand");
        CHECK(accepted.fragments == std::vector<int>{1});
        CHECK(accepted.by == "hand");
        walk.keep("accepted");

        // Where it was accepted it may be in the way of the third, which is then offered a place that is not possible: a
        // click in the scene keeps what is offered.
        choose("fragment_03");
        press("snap to fit");
        REQUIRE(waits_for_end("searching for a fit"));
        Person::wait(1.0);
        walk.keep("offered");
        if (walk.shows("leave it")) {
            const Spot scene = walk.eyes.spot("scene picture");
            person.click(scene.left + 12.0, scene.bottom - 12.0);
            Person::wait(0.5);
            CHECK(walk.shows("leave it"));
            press("leave it");
            REQUIRE(walk.waits_while("leave it"));
        }
        // The second, then the third, to where their fractures fit, or to the best place that they allow.
        for (const std::string name : {"fragment_02", "fragment_03"}) {
            save();
            Person::wait(1.0);
            const std::size_t count = saved().steps.size();
            choose(name);
            press("snap to fit");
            REQUIRE(waits_for_end("searching for a fit"));
            Person::wait(1.0);
            walk.keep("snapped-" + name);
            // A place that the fracture alone does not make certain is a decision.
            const bool is_certain = !walk.shows("put it there");
            if (!is_certain) press("put it there");
            REQUIRE(has_steps(count + 1));
            CHECK(saved().steps.back().fit.has_value() == is_certain);
            if (is_certain) continue;
            press("accept");
            REQUIRE(waits_for_end("place is measured"));
            REQUIRE(has_steps(count + 2));
            CHECK(plan::state_of(saved()).holds(name == "fragment_02" ? 1 : 2));
        }
        CHECK(plan::state_of(saved()).holds(1));
        const std::size_t placed = saved().steps.size();

        walk.press("part fragment_02", "panel tree");
        person.key("Control_L", true);
        walk.press("part fragment_03", "panel tree");
        person.key("Control_L", false);
        press("group");
        REQUIRE(has_steps(placed + 1));
        CHECK(plan::state_of(saved()).arrangement.move_together(1, 2));
        press("undo step");
        REQUIRE(walk.until([&] { return !plan::state_of(saved()).arrangement.move_together(1, 2); }, save));
        walk.keep("undone");
        const std::string content = plan::plan_text(saved());

        // A crash between two steps: the one that was not saved is offered.
        press("redo step");
        REQUIRE(sees([&] { return fs::exists(kept) && fs::file_size(kept) > 0; }));
        Person::wait(1.0);
        walk.kill();
        CHECK(plan::plan_text(saved()) == content);
        fs::remove(walk.folder.path / "spots.txt");  // of the window that is no more
        walk.start("view hip.plan.json --layout plan", 300.0);
        REQUIRE(walk.waits_for("restore steps"));
        walk.keep("offered");
        walk.press("restore steps");
        Person::wait(1.0);
        REQUIRE(walk.until([&] { return plan::state_of(saved()).arrangement.move_together(1, 2); }, save));
        CHECK_FALSE(fs::exists(kept));
        const std::string restored = plan::plan_text(saved());
        walk.stop();

        fs::remove(walk.folder.path / "spots.txt");
        walk.start("view hip.plan.json --layout plan", 300.0);
        REQUIRE(walk.waits_for("alternative main"));
        Person::wait(3.0);
        walk.keep("reopened");
        CHECK_FALSE(walk.shows("restore steps"));
        walk.stop();
        CHECK(plan::plan_text(saved()) == restored);
    }
}
