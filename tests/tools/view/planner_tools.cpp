// SPDX-License-Identifier: Apache-2.0
// A planner with a mouse: maps, alternatives, sections and measurements of a plan.
#include "assets/cases/plan_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/view/eyes.hpp"

#include <algorithm>
#include <cstdlib>
#include <future>

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

TEST_CASE("a planner with a mouse shows maps, goes between alternatives, compares, cuts, measures and saves for Slicer",
          "[display][live]") {
    if (!std::getenv("TACTUS_PERSON")) return skip("takes a minute of a quiet machine; TACTUS_PERSON=1 runs it");
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("script", watching_script("size 1600 1000\nlayout plan\nfrom front\n", 400.0));
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder,
                  "run planning-trauma --view --view-script script --set hand.device=mouse --audio none --out out "
                  "--seconds 500 --json",
                  520);
    });
    REQUIRE(person.sees_window("Planning", 60.0));
    const Eyes eyes{folder.path};
    const auto shows = [&](const std::string& control) { return sees([&] { return eyes.spots().contains(control); }); };
    const auto plan = [&] { return cases::load_case_plan(folder.path / "out/case.plan.json"); };
    const auto comes = [&](auto&& what) {
        for (int i = 0; i < 300; ++i) {
            if (fs::exists(folder.path / "out/case.plan.json") && what()) return true;
            Person::wait(0.2);
        }
        return false;
    };
    REQUIRE(shows("new from here"));
    REQUIRE(comes([&] { return plan().alternatives.size() == 1; }));
    const Spot scene = eyes.spot("scene picture");
    Person::wait(3.0);
    const int red = count(person, scene, is_red);

    // Maps: fragments that face nothing are grey, their painted fractures, too.
    press(person, eyes, "gap map");
    CHECK(comes([&] { return count(person, scene, is_red) < red / 2; }));
    keep(person, "planner-1-gap-map");
    press(person, eyes, "gap map");
    CHECK(comes([&] { return count(person, scene, is_red) > red * 3 / 4; }));
    // Without a healthy side there is no such map, and the window says so.
    press(person, eyes, "mirror map");
    Person::wait(2.0);
    keep(person, "planner-2-no-mirror-map");

    // Another alternative, in which a fragment is hidden.
    press(person, eyes, "new from here");
    REQUIRE(comes([&] { return plan().alternatives.size() == 2; }));
    CHECK(plan().current == 1);
    press(person, eyes, "part fragment_01");
    press(person, eyes, "hide in plan");
    CHECK(comes([&] { return cases::state_of(plan()).arrangement.is_hidden(0); }));
    REQUIRE(shows("alternative main"));
    press(person, eyes, "alternative main");
    CHECK(comes([&] { return plan().current == 0 && !cases::state_of(plan()).arrangement.is_hidden(0); }));
    const std::string other = plan().alternatives[1].name;
    press(person, eyes, "compare " + other);
    Person::wait(8.0);
    keep(person, "planner-3-compared");
    press(person, eyes, "drop " + other);
    CHECK(comes([&] { return plan().alternatives.size() == 1; }));
    press(person, eyes, "undrop");
    CHECK(comes([&] { return plan().alternatives.size() == 2; }));

    // A section: the fifth line of the list of planes is across the view.
    press(person, eyes, "clip");
    Person::wait(1.0);
    keep(person, "planner-4-planes");
    for (int n = 0; n < 4; ++n) person.tap("Down");
    person.tap("Return");
    Person::wait(6.0);
    keep(person, "planner-5-section");
    const int grey = count(person, scene, [](int r, int g, int b) { return r == g && g == b && r > 30 && r < 250; });
    CHECK(grey > 200);

    // Two points, kept, and written for Slicer.
    press(person, eyes, "measure");
    const double x = 0.5 * (scene.left + scene.right), y = 0.5 * (scene.top + scene.bottom);
    for (int n = 0; n < 24 && !eyes.spots().contains("keep measurement"); ++n) {
        person.click(x + 14.0 * (n % 6) - 35.0, y + 20.0 * (n / 6) - 30.0);
        Person::wait(1.0);
    }
    REQUIRE(shows("keep measurement"));
    press(person, eyes, "keep measurement");
    REQUIRE(shows("save for Slicer"));
    keep(person, "planner-6-measured");
    press(person, eyes, "save for Slicer");
    REQUIRE(comes([&] { return fs::exists(folder.path / "out/measurements-1.mrk.json"); }));
    const std::string marks = slurp(folder.path / "out/measurements-1.mrk.json");
    CHECK(marks.find("\"controlPoints\"") != std::string::npos);
    CHECK(marks.find("\"LPS\"") != std::string::npos);
    interrupt(folder.path);
    done.wait();
}
