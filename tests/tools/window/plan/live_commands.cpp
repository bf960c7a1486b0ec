// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/live_commands.hpp"

#include "tests/tools/window/plan/plan_rig.hpp"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

TEST_CASE("commands that are given in a pause all take effect when the run goes on", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    const std::size_t before = rig.run.steps().size();
    REQUIRE(rig.pause(true));
    rig.run.press("lock", 3);
    rig.run.press("lock", 5);
    rig.pictures(60);
    CHECK(rig.has_told("the run is paused: the change comes when it goes on"));
    REQUIRE(rig.pause(false));
    CHECK(rig.comes([&] { return rig.run.steps().size() >= before + 2; }, 600));
    CHECK(rig.is_locked(3));
    CHECK(rig.is_locked(5));

    // As many steps are undone as were asked for.
    REQUIRE(rig.pause(true));
    rig.run.press("undo");
    rig.run.press("undo");
    rig.pictures(60);
    REQUIRE(rig.pause(false));
    CHECK(rig.comes([&] { return !rig.is_locked(3) && !rig.is_locked(5); }, 600));
}

TEST_CASE("a run whose time goes slowly does each of several steps", "[virtual][slow]") {
    PlanRig rig("planning-trauma", 20.0);
    rig.run.press("lock", 3);
    rig.run.press("lock", 5);
    CHECK(rig.comes([&] { return rig.is_locked(5); }, 2000));
    CHECK(rig.is_locked(3));
}

TEST_CASE("an edit of the patch does not drop the commands that wait", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    for (const int fragment : {2, 3, 5}) rig.run.press("lock", fragment);
    rig.picture();
    REQUIRE(rig.bench.set("case", "loose", "9 mm"));
    CHECK(rig.comes([&] { return rig.is_locked(2) && rig.is_locked(3) && rig.is_locked(5); }, 600));
}

TEST_CASE("a button that is pressed elsewhere after a command does not mean the fragment of that command",
          "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    rig.run.press("lock", 3);
    REQUIRE(rig.comes([&] { return rig.is_locked(3) && rig.run.is_settled(); }, 600));
    rig.bench.press("lock");
    rig.pictures(150);
    CHECK(rig.is_locked(3));
}
