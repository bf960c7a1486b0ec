// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/live_commands.hpp"

#include "dsp/core/rotation.hpp"
#include "tests/tools/window/plan/plan_rig.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

TEST_CASE("commands that are given in a pause all take effect when the run goes on", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    const std::size_t before = rig.run.steps().size();
    REQUIRE(rig.pause(true));
    rig.run.toggle_lock({3});
    rig.run.toggle_lock({5});
    rig.pictures(60);
    CHECK(rig.has_told("the run is paused: the change comes when it goes on"));
    REQUIRE(rig.pause(false));
    CHECK(rig.comes([&] { return rig.run.steps().size() >= before + 2; }, 600));
    CHECK(rig.is_locked(3));
    CHECK(rig.is_locked(5));

    // As many steps are undone as were asked for.
    REQUIRE(rig.pause(true));
    rig.run.give(plan::UndoStep{});
    rig.run.give(plan::UndoStep{});
    rig.pictures(60);
    REQUIRE(rig.pause(false));
    CHECK(rig.comes([&] { return !rig.is_locked(3) && !rig.is_locked(5); }, 600));
}

TEST_CASE("steps that a run was asked for in a pause are in the opened plan when the run is ended", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    PlanDocument document(rig.run.newest(), rig.folder.path / "opened.plan.json");
    REQUIRE(rig.pause(true));
    rig.run.toggle_lock({3});
    rig.pictures(60);
    SECTION("with an opened plan") {
        rig.run.use(&document);
        rig.bench.stop();
        CHECK(rig.comes([&] { return rig.run.plan() == &document.plan() && rig.is_locked(3); }, 1000));
    }
    SECTION("without one it is told") {
        rig.bench.stop();
        CHECK(rig.comes([&] { return rig.has_told("1 step not done: the run has ended"); }, 1000));
    }
    CHECK_FALSE(rig.run.is_asked());
}

TEST_CASE("a plan that is left in a pause has the steps that waited, whether pictures follow or not", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    PlanDocument document(rig.run.newest(), rig.folder.path / "opened.plan.json");
    rig.run.use(&document);
    CHECK_FALSE(rig.run.brings_what_waits());
    REQUIRE(rig.pause(true));
    rig.run.toggle_lock({3});
    rig.pictures(20);
    const auto is_locked = [&] { return plan::state_of(document.plan()).arrangement.is_locked(3); };
    REQUIRE_FALSE(is_locked());
    SECTION("pictures follow") { CHECK(rig.comes([&] { return !rig.run.brings_what_waits(); }, 1000)); }
    SECTION("none follows") { rig.run.take_what_waits(); }
    CHECK(is_locked());
    CHECK(document.has_unsaved_steps());
    CHECK_FALSE(rig.run.is_asked());
}

TEST_CASE("a run whose time goes slowly does each of several steps", "[virtual][slow]") {
    PlanRig rig("planning-trauma", 20.0);
    rig.run.toggle_lock({3});
    rig.run.toggle_lock({5});
    CHECK(rig.comes([&] { return rig.is_locked(5); }, 2000));
    CHECK(rig.is_locked(3));
}

TEST_CASE("an edit of the patch does not drop the commands that wait", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    for (const int fragment : {2, 3, 5}) rig.run.toggle_lock({fragment});
    rig.picture();
    REQUIRE(rig.bench.set("case", "loose", "9 mm"));
    CHECK(rig.comes([&] { return rig.is_locked(2) && rig.is_locked(3) && rig.is_locked(5); }, 600));
}

TEST_CASE("a button that is pressed elsewhere after a command does not mean the fragment of that command",
          "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    rig.run.toggle_lock({3});
    REQUIRE(rig.comes([&] { return rig.is_locked(3) && rig.run.is_settled(); }, 600));
    rig.bench.press("lock");
    rig.pictures(150);
    CHECK(rig.is_locked(3));
}

TEST_CASE("a command that moves what a hand holds releases it first, and its force fades without a jump",
          "[virtual][slow]") {
    PlanRig rig("planning-trauma", 1.0, {});
    // The hand of the example leads a fragment to its fit.
    REQUIRE(rig.comes([&] { return rig.run.held_last() >= 0 && rig.bench.status()->force > 0.5; }, 6000));
    const int held = rig.run.held_last();
    const Pose there{Vec3(0.0, 0.0, 0.3), {1.0, 0.0, 0.0, 0.0}};
    rig.run.give(plan::PlaceFragment{held, there});
    REQUIRE(rig.comes(
        [&] {
            const auto& steps = rig.run.plan()->steps;
            return !steps.empty() && steps.back().poses.size() == 1 &&
                   glm::length(steps.back().poses[0].position - there.position) == 0.0;
        },
        1000));
    rig.pictures(20);
    rig.bench.stop();
    REQUIRE(rig.comes([&] { return rig.bench.status()->state == RunStatus::State::over; }, 1000));
    // Each row: time, force, torque. 10 N fade in 50 ms.
    std::istringstream rows(slurp(rig.folder.path / "out/force.csv"));
    std::string line;
    Vec3 before(0.0);
    double greatest = 0.0, jump = 0.0;
    while (std::getline(rows, line)) {
        if (line.empty() || line[0] == '#' || !(std::isdigit(static_cast<unsigned char>(line[0])) != 0)) continue;
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        double time = 0.0;
        Vec3 force(0.0);
        words >> time >> force.x >> force.y >> force.z;
        greatest = std::max(greatest, glm::length(force));
        jump = std::max(jump, glm::length(force - before));
        before = force;
    }
    INFO(greatest << " N at most");
    CHECK(greatest > 0.5);
    CHECK(jump < 0.3);
    CHECK(glm::length(before) < 1e-6);
}

TEST_CASE("the commands of a window are in the take, and its replay repeats them to the bit", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    rig.bench.record(true);
    REQUIRE(rig.comes([&] { return rig.bench.is_recording(); }, 1000));
    const std::size_t before = rig.run.plan()->steps.size();
    rig.run.give(plan::PlaceFragment{4, {Vec3(0.01, 0.02, 0.123456789), rotation_by({0.1, 0.2, 0.3})}});
    rig.run.give(plan::JoinFragments{plan::set_of({4, 5})});
    rig.run.give(plan::UndoStep{});
    REQUIRE(rig.comes([&] { return rig.run.plan()->steps.size() == before + 2 && !rig.run.is_asked(); }, 1000));
    rig.bench.stop();
    REQUIRE(rig.comes([&] { return rig.bench.status()->state == RunStatus::State::over; }, 1000));
    // It compares the hash of every output, that of the commands among them.
    const Outcome again = rig.folder.tactus("replay " + rig.bench.take().string());
    INFO(again.out << again.err);
    CHECK(again.code == 0);
    const std::string events = slurp(rig.bench.take() / "events.jsonl");
    CHECK(events.find("command_number") != std::string::npos);
}
