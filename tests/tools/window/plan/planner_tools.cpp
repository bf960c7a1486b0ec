// SPDX-License-Identifier: Apache-2.0
// A planner with a mouse: maps, alternatives, sections and measurements of a plan.
#include "assets/plan/plan_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/walk.hpp"

#include <algorithm>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// Pixels of the scene that are like one in a picture of it.
template <class Like>
int count(const Person& person, const Spot& scene, Like&& like) {
    const Picture seen = person.look();
    int found = 0;
    for (int y = static_cast<int>(scene.top); y < std::min(static_cast<int>(scene.bottom), seen.height); ++y)
        for (int x = static_cast<int>(scene.left); x < std::min(static_cast<int>(scene.right), seen.width); ++x) {
            const std::size_t at = 3 * static_cast<std::size_t>(y * seen.width + x);
            found += like(seen.rgb[at], seen.rgb[at + 1], seen.rgb[at + 2]) ? 1 : 0;
        }
    return found;
}

bool is_red(int r, int g, int b) { return r > 90 && r > 2 * g && r > 2 * b; }

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a planner with a mouse shows maps, goes between alternatives, compares, cuts, measures and saves for Slicer",
          "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "planner");
        if (!walk.is_possible()) return;
        walk.start(
            "run planning-trauma --view --layout plan --set hand.device=mouse --audio none --out out --seconds 280 "
            "--json",
            280.0);
        const fs::path folder = walk.folder.path;
        const Person& person = walk.person;
        const auto press = [&](const std::string& control) { walk.press(control, "panel plan steps"); };
        const auto plan = [&] { return plan::load_case_plan(folder / "out/case.plan.json"); };
        const auto comes = [&](auto&& what) {
            for (int i = 0; i < 300; ++i) {
                if (fs::exists(folder / "out/case.plan.json") && what()) return true;
                Person::wait(0.2);
            }
            return false;
        };
        REQUIRE(walk.waits_for("part fragment_02"));
        walk.person.tap("1");
        REQUIRE(walk.waits_for("scene picture"));
        REQUIRE(comes([&] { return plan().alternatives.size() == 1; }));
        const Spot scene = walk.eyes.spot("scene picture");
        Person::wait(1.5);
        const int red = count(person, scene, is_red);

        // Maps: fragments that face nothing are grey, their painted fractures, too.
        press("gap map");
        CHECK(comes([&] { return count(person, scene, is_red) < red / 2; }));
        walk.keep("gap-map");
        press("gap map");
        CHECK(comes([&] { return count(person, scene, is_red) > red * 3 / 4; }));
        // Without a healthy side there is no such map, and the window says so.
        press("mirror map");
        Person::wait(2.0);
        walk.keep("no-mirror-map");

        // Another alternative, in which a fragment is hidden.
        press("new from here");
        REQUIRE(comes([&] { return plan().alternatives.size() == 2; }));
        CHECK(plan().current == 1);
        walk.press("part fragment_01", "panel tree");
        press("hide in plan");
        CHECK(comes([&] { return plan::state_of(plan()).arrangement.is_hidden(0); }));
        CHECK(walk.waits_for("hidden fragment_01", "panel tree"));
        REQUIRE(walk.waits_for("alternative main", "panel plan steps"));
        press("alternative main");
        CHECK(comes([&] { return plan().current == 0 && !plan::state_of(plan()).arrangement.is_hidden(0); }));
        CHECK(walk.waits_for("part fragment_01", "panel tree"));
        const std::string other = plan().alternatives[1].name;
        press("compare " + other);
        Person::wait(8.0);
        walk.keep("compared");
        press("drop " + other);
        CHECK(comes([&] { return plan().alternatives.size() == 1; }));
        press("restore alternative");
        CHECK(comes([&] { return plan().alternatives.size() == 2; }));

        // A section: the fourth line of the list of planes lies across the view from above. The legend
        // of its greys is below.
        walk.person.tap("5");
        Person::wait(2.0);
        Spot above_legend = scene;
        above_legend.bottom -= 0.15 * (scene.bottom - scene.top);
        const auto greys = [&] {
            return count(person, above_legend,
                         [](int r, int g, int b) { return r == g && g == b && r > 30 && r < 250; });
        };
        const int before = greys();
        walk.press("clip");
        Person::wait(1.0);
        walk.keep("planes");
        for (int n = 0; n < 3; ++n) walk.person.tap("Down");
        walk.person.tap("Return");
        CHECK(sees([&] { return greys() > before + 1000; }));
        walk.keep("section");
        walk.press("clip");
        Person::wait(1.0);
        for (int n = 0; n < 3; ++n) walk.person.tap("Up");
        walk.person.tap("Return");
        walk.person.tap("1");
        Person::wait(2.0);

        // Two points, kept, and written for Slicer.
        walk.measure();
        walk.press("keep measurement", "panel tree");
        REQUIRE(walk.waits_for("save for Slicer", "panel tree"));
        walk.keep("measured");
        walk.press("save for Slicer", "panel tree");
        REQUIRE(comes([&] { return fs::exists(folder / "out/measurements-1.mrk.json"); }));
        const std::string marks = slurp(folder / "out/measurements-1.mrk.json");
        CHECK(marks.find("\"controlPoints\"") != std::string::npos);
        CHECK(marks.find("\"LPS\"") != std::string::npos);
        walk.stop();
    }
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a planner with a mouse gives an alternative another name, but not that of another one", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "name");
        if (!walk.is_possible()) return;
        walk.start(
            "run planning-trauma --view --layout plan --set hand.device=mouse --audio none --out out --seconds 150 "
            "--json",
            150.0);
        const auto plan = [&](const char* out) {
            const fs::path file = walk.folder.path / out / "case.plan.json";
            return fs::exists(file) ? plan::load_case_plan(file) : plan::CasePlan{};
        };
        const auto name = [&](const std::string& old, const std::string& wanted) {
            REQUIRE(walk.waits_for("alternative " + old, "panel plan steps"));
            REQUIRE(walk.until([&] { return walk.shows("name of the alternative"); },
                               [&] {
                                   const Spot at = walk.eyes.spot("alternative " + old);
                                   walk.person.double_click(0.5 * (at.left + at.right), 0.5 * (at.top + at.bottom));
                               }));
            walk.person.type(wanted);
            walk.person.tap("Return");
            CHECK(walk.waits_while("name of the alternative"));
        };
        REQUIRE(walk.waits_for("part fragment_02"));
        REQUIRE(sees([&] { return fs::exists(walk.folder.path / "out/case.plan.json"); }));
        walk.press("new from here", "panel plan steps");
        REQUIRE(sees([&] { return plan("out").alternatives.size() == 2; }));
        name("main", "before");
        // A new run begins with it; the other one, its steps and which one is current stay.
        REQUIRE(walk.waits_for("alternative before", "panel plan steps"));
        REQUIRE(sees([&] { return plan("out-2").alternatives.size() == 2; }));
        CHECK(plan("out-2").alternatives[0].name == "before");
        CHECK(plan("out-2").steps.size() == plan("out").steps.size());
        const std::string other = plan("out-2").alternatives[1].name;
        name("before", other);
        walk.keep("refused");
        CHECK(walk.shows("alternative before"));
        CHECK_FALSE(fs::exists(walk.folder.path / "out-3"));
        walk.stop();
    }
}
