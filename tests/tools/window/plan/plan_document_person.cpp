// SPDX-License-Identifier: Apache-2.0
// A person opens a plan, changes it, saves it and finds it again.
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/walk.hpp"

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("an opened plan is seen and changed without a run, saved by Ctrl+S and restored after kill -9", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "document");
        if (!walk.is_possible()) return;
        const fs::path file = walk.folder.path / "jaw.plan.json", kept = walk.folder.path / "jaw.plan.unsaved.json";
        const fs::path bundled = library_folder() / "cases/mandible-twelve/case.plan.json";
        plan::CasePlan plan = plan::load_case_plan(bundled);
        plan::make_files_absolute(plan, bundled.parent_path());
        plan::save_case_plan(plan, file);
        const std::size_t steps = plan.steps.size();
        const auto is_locked = [&](int fragment) {
            return plan::state_of(plan::load_case_plan(file)).arrangement.is_locked(fragment);
        };
        REQUIRE_FALSE((is_locked(2) || is_locked(4)));
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto save = [&] {
            walk.person.key("Control_L", true);
            walk.person.tap("s");
            walk.person.key("Control_L", false);
        };

        walk.start("view jaw.plan.json --layout plan", 200.0);
        REQUIRE(walk.waits_for("part fragment_12", "panel tree"));
        walk.keep("opened");
        walk.press("part fragment_03", "panel tree");
        press("lock");
        Person::wait(1.0);
        CHECK_FALSE(is_locked(2));
        save();
        REQUIRE(sees([&] { return is_locked(2); }));
        walk.keep("saved");
        press("undo step");
        REQUIRE(sees([&] { return fs::exists(kept) && fs::file_size(kept) > 0; }));
        Person::wait(1.0);
        walk.kill();
        CHECK(is_locked(2));

        walk.start("view jaw.plan.json --layout plan", 300.0);
        REQUIRE(walk.waits_for("restore steps"));
        walk.keep("offered");
        walk.press("restore steps");
        Person::wait(1.0);
        save();
        REQUIRE(sees([&] { return !is_locked(2); }));
        CHECK(sees([&] { return !fs::exists(kept); }));
        // The step stays, and can be redone.
        CHECK(plan::load_case_plan(file).steps.size() == steps + 1);

        // A run shows and changes the same plan.
        walk.person.tap("F5");
        const fs::path of_run = walk.folder.path / "planning-trauma-run/case.plan.json";
        REQUIRE(sees([&] { return fs::exists(of_run); }));
        // With the first ticks the list is that of the run, and what was chosen before is not chosen any more.
        REQUIRE(sees([&] { return !walk.eyes.last_row("planning-trauma-run/fragment.csv").empty(); }));
        Person::wait(1.0);
        walk.eyes.look_again();
        REQUIRE(walk.waits_for("part fragment_12", "panel tree"));
        const auto is_locked_in_run = [&] {
            return plan::state_of(plan::load_case_plan(of_run)).arrangement.is_locked(4);
        };
        for (int n = 0; n < 2 && !is_locked_in_run(); ++n) {
            walk.press("part fragment_05", "panel tree");
            press("lock");
            sees(is_locked_in_run);
        }
        REQUIRE(is_locked_in_run());
        Person::wait(1.0);
        save();
        REQUIRE(sees([&] { return is_locked(4); }));
        CHECK(sees([&] { return !fs::exists(kept); }));
        walk.keep("run");
        walk.stop();
        // Nothing is left that a later window would ask about.
        CHECK_FALSE(fs::exists(kept));
    }
}
