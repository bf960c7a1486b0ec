// SPDX-License-Identifier: Apache-2.0
// A person with a mouse drags fragments of an opened plan, lets one snap, groups, undoes, saves, and finds all of it again.
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/jaw_case.hpp"
#include "tests/tools/window/walk.hpp"

#include <string>
#include <tuple>
#include <utility>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a person drags fragments with the mouse, snaps, groups, undoes, saves and reopens a plan without a run",
          "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "drag");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        const fs::path file = walk.folder.path / "jaw.plan.json";
        plan::CasePlan plan = plan::load_case_plan(case_folder() / "case.plan.json");
        plan::make_files_absolute(plan, case_folder());
        plan::save_case_plan(plan, file);
        const std::size_t steps = plan.steps.size();
        const auto saved = [&] { return plan::load_case_plan(file); };
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto save = [&] { person.chord({"Control_L"}, "s"); };
        const auto has_steps = [&](std::size_t count) {
            return walk.until([&] { return saved().steps.size() == count; }, save);
        };
        const auto middle = [&](const std::string& name) {
            const Spot at = walk.eyes.resting_spot(name);
            return std::pair(0.5 * (at.left + at.right), 0.5 * (at.top + at.bottom));
        };
        const auto choose = [&](const std::string& name) {
            walk.press("part " + name, "panel tree");
            // A slow machine still makes its surface; then the view is fitted to all of them.
            const auto is_seen = [&] {
                const auto spots = walk.eyes.spots();
                const auto scene = spots.find("scene picture"), handle = spots.find("handle z");
                return scene != spots.end() && handle != spots.end() && handle->second.top > scene->second.top &&
                       handle->second.bottom < scene->second.bottom && handle->second.left > scene->second.left &&
                       handle->second.right < scene->second.right;
            };
            for (int n = 0; n < 120 && !is_seen(); ++n) {
                Person::wait(1.0);
                person.tap("1");
                walk.eyes.look_again();
            }
            walk.keep("choosing-" + name);
            REQUIRE(is_seen());
        };

        walk.start("view jaw.plan.json --layout plan", 600.0);
        REQUIRE(walk.waits_for("part fragment_12", "panel tree"));
        REQUIRE(walk.waits_while("bones are loaded"));
        person.tap("1");
        Person::wait(1.5);

        // The first by an arrow, the second by the fragment itself, in the plane of the view.
        choose("fragment_07");
        walk.keep("chosen");
        auto [x, y] = middle("handle z");
        person.click(x, y);
        Person::wait(1.0);
        choose("fragment_07");
        const double before = plan::state_of(plan).arrangement.pose(6).position.z;
        std::tie(x, y) = middle("handle z");
        person.drag(x, y, x, y - 50.0, 1.5);
        REQUIRE(has_steps(steps + 1));
        const plan::PlanStep up = saved().steps.back();
        CHECK(up.fragments == std::vector<int>{6});
        CHECK(up.poses[0].position.z - before > 5e-3);
        walk.keep("dragged");

        choose("fragment_02");
        std::tie(x, y) = middle("turn handle y");
        person.drag(x, y, x - 30.0, y - 30.0, 1.5);
        REQUIRE(has_steps(steps + 2));
        CHECK(saved().steps.back().fragments == std::vector<int>{1});
        walk.keep("turned");

        // The third snaps by its button; where no fit is certain, the best candidate is put there.
        choose("fragment_07");
        press("snap to fit");
        REQUIRE(walk.waits_while("searching for a fit"));
        Person::wait(1.0);
        walk.keep("snapped");
        if (walk.shows("put it there")) press("put it there");
        REQUIRE(has_steps(steps + 3));
        CHECK(saved().steps.back().fragments.front() == 6);

        walk.press("part fragment_01", "panel tree");
        person.key("Control_L", true);
        walk.press("part fragment_07", "panel tree");
        person.key("Control_L", false);
        press("group");
        REQUIRE(has_steps(steps + 4));
        CHECK(plan::state_of(saved()).arrangement.move_together(0, 6));
        press("undo step");
        REQUIRE(walk.until([&] { return !plan::state_of(saved()).arrangement.move_together(0, 6); }, save));
        walk.keep("undone");
        const std::string content = plan::content_of(saved());
        walk.kill();

        fs::remove(walk.folder.path / "spots.txt");  // of the window that is no more
        walk.start("view jaw.plan.json --layout plan", 300.0);
        REQUIRE(walk.waits_for("alternative main"));
        Person::wait(2.0);
        walk.keep("reopened");
        CHECK_FALSE(walk.shows("restore steps"));
        CHECK(plan::content_of(saved()) == content);
        walk.stop();
    }
}
