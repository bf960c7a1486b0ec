// SPDX-License-Identifier: Apache-2.0
// The command line, the window and a tick change a plan in the same way.
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/jaw_case.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/case_run.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

struct SameCommand {
    std::string verb, rest;  ///< of the command line, before and after the plan
    plan::PlanCommand command;
};

std::string numbers_of_pose(const Pose& pose) {
    const Vec3& p = pose.position;
    const Quat& q = pose.orientation;
    return fmt::format("--pose={:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", p.x * 1e3, p.y * 1e3,
                       p.z * 1e3, q.w, q.x, q.y, q.z);
}

double rounded(double value) { return std::round(value * 1e10) * 1e-10 + 0.0; }

/// What lies where, what moves together and what is fitted, of every step; not who did it and when.
std::string meaning_of(plan::CasePlan plan) {
    for (plan::PlanStep& step : plan.steps) {
        step.by.clear();
        step.time.clear();
        // The command line has them in mm, so that their last bits differ.
        for (Pose& pose : step.poses) {
            for (int a = 0; a < 3; ++a) pose.position[a] = rounded(pose.position[a]);
            for (int a = 0; a < 4; ++a) pose.orientation[a] = rounded(pose.orientation[a]);
        }
    }
    return plan::content_of(std::move(plan));
}

}  // namespace

TEST_CASE("the same commands by the command line, by the window and in a tick leave the same plan", "[slow]") {
    const Folder folder;
    plan::CasePlan begun = plan::load_case_plan(case_folder() / "case.plan.json");
    plan::make_files_absolute(begun, case_folder());
    const auto by_line = folder.path / "line.plan.json", by_window = folder.path / "window.plan.json";
    for (const auto& file : {by_line, by_window}) plan::save_case_plan(begun, file);
    RunChoice choice;
    choice.patch = (library_folder() / "patches/planning-trauma.toml").string();
    choice.out = folder.path / "out";
    choice.audio = "none";
    Workbench bench(choice);
    CaseRun run(bench);
    PlanDocument document(by_window);
    run.use(&document);
    const auto picture = [&] {
        bench.tend();
        run.tend(bench.observer());
    };
    picture();
    plan::PlanHistory tick(begun);

    const Pose there{Vec3(0.031, -0.02, 0.0125), rotation_by({0.1, -0.2, 0.3})};
    const auto some = [](std::initializer_list<int> all) { return plan::set_of(all); };
    const SameCommand all[] = {
        {"move", "fragment_03 " + numbers_of_pose(there), plan::PlaceFragment{2, there}},
        {"group", "fragment_05 fragment_03 fragment_04", plan::JoinFragments{some({2, 3, 4})}},
        {"group", "fragment_06 fragment_07", plan::JoinFragments{some({5, 6})}},
        {"add", "group_1 fragment_07", plan::AddFragments{0, some({6})}},
        {"move", "fragment_04 " + numbers_of_pose(there), plan::PlaceFragment{3, there}},
        {"lock", "fragment_08 fragment_09", plan::LockFragments{some({7, 8})}},
        {"lock", "fragment_08", plan::LockFragments{some({7})}},
        {"undo", "", plan::UndoStep{}},
        {"redo", "", plan::RedoStep{}},
        {"hide", "fragment_10 fragment_11", plan::HideFragments{some({9, 10})}},
        {"unhide", "fragment_11 fragment_12", plan::HideFragments{some({10, 11}), false}},
        {"remove", "fragment_03 fragment_12", plan::SplitFragments{some({2, 11})}},
        {"alternative", "\"alternative 2\"", plan::GoToAlternative{1}},
        {"undo", "", plan::UndoStep{}},
        {"unlock", "fragment_08", plan::LockFragments{some({7}), false}},
        {"ungroup", "group_1", plan::DissolveGroup{0}},
        {"alternative", "main", plan::GoToAlternative{0}},
        {"alternative", "\"alternative 2\" --remove", plan::DropAlternative{1}},
    };
    for (const SameCommand& each : all) {
        INFO(each.verb << " " << each.rest);
        const Outcome done = folder.tactus("plan " + each.verb + " " + by_line.string() + " " + each.rest);
        INFO(done.err);
        REQUIRE(done.code == 0);
        run.give(each.command);
        picture();
        tick.apply(each.command);
        const plan::CasePlan line = plan::load_case_plan(by_line);
        REQUIRE(meaning_of(line) == meaning_of(document.plan()));
        const plan::PlanState state = plan::state_of(document.plan());
        REQUIRE(tick.count() == static_cast<int>(line.steps.size()));
        REQUIRE(tick.place().head == line.place().head);
        for (int n = 0; n < static_cast<int>(tick.now().size()); ++n) {
            REQUIRE(std::bit_cast<std::array<double, 7>>(state.arrangement.pose(n)) ==
                    std::bit_cast<std::array<double, 7>>(tick.now().pose(n)));
            REQUIRE(state.arrangement.outermost(n) == tick.now().outermost(n));
            REQUIRE(state.arrangement.is_locked(n) == tick.now().is_locked(n));
            REQUIRE(state.arrangement.is_hidden(n) == tick.now().is_hidden(n));
        }
    }
    // What cannot be done leaves the file as it is, and says why.
    const std::string before = slurp(by_line);
    const Outcome refused = folder.tactus("plan move " + by_line.string() + " fragment_08 " + numbers_of_pose(there));
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Matchers::ContainsSubstring("is locked"));
    const Outcome so = folder.tactus("plan hide " + by_line.string() + " fragment_10");
    CHECK(so.code == 0);
    CHECK(so.out == "the plan is already so\n");
    CHECK(slurp(by_line) == before);
}
