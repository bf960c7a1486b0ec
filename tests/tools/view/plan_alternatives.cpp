// SPDX-License-Identifier: Apache-2.0
#include "tools/view/plan/plan_alternatives.hpp"

#include "assets/cases/plan_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::view;

TEST_CASE("another name for an alternative keeps the step that was asked for just before", "[live]") {
    const Folder folder;
    RunChoice choice;
    choice.patch = (library_folder() / "patches/planning-trauma.toml").string();
    choice.out = folder.path / "out";
    choice.audio = "none";
    choice.json = true;
    Workbench bench(choice);
    CaseRun run(bench);
    ScenePanel scene(bench);
    PlanAlternatives alternatives(bench, run, scene);
    bench.run();
    const auto comes = [&](auto&& what) {
        for (int i = 0; i < 6000; ++i) {
            bench.tend();
            run.tend(bench.observer());
            alternatives.tend();
            if (what()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    REQUIRE(comes([&] { return run.plan() != nullptr; }));
    constexpr int fragment = 3;
    REQUIRE_FALSE(cases::state_of(*run.plan()).arrangement.is_locked(fragment));
    run.press("lock", fragment);
    alternatives.rename("main", "before");
    std::filesystem::path made;
    REQUIRE(comes([&] { return !(made = alternatives.take_changed()).empty(); }));
    const cases::CasePlan plan = cases::load_case_plan(made);
    CHECK(plan.alternatives[0].name == "before");
    CHECK(cases::state_of(plan).arrangement.is_locked(fragment));
    CHECK(alternatives.take_changed().empty());
    bench.stop();
}
