// SPDX-License-Identifier: Apache-2.0
#include "tools/view/plan/flap_run.hpp"

#include "assets/cases/plan_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <atomic>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::view;

TEST_CASE("a change of a reconstruction keeps the steps that the run made while it was computed", "[live]") {
    const Folder folder;
    RunChoice choice;
    choice.patch = (library_folder() / "patches/planning-reconstruction.toml").string();
    choice.out = folder.path / "out";
    choice.audio = "none";
    choice.json = true;
    Workbench bench(choice);
    CaseRun run(bench);
    FlapRun flap(bench, run);
    bench.run();
    const auto comes = [&](auto&& what) {
        for (int i = 0; i < 6000; ++i) {
            bench.tend();
            run.tend(bench.observer());
            flap.tend();
            if (what()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    REQUIRE(comes([&] { return flap.reconstruction() != nullptr; }));
    constexpr int segment = 3;
    REQUIRE_FALSE(cases::state_of(*run.plan()).arrangement.is_locked(segment));

    std::atomic<bool> may_end = false;
    flap.change([&](reconstruct::Reconstruction& all) {
        for (int i = 0; i < 6000 && !may_end; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        all.flap.margin = 7e-3;
    });
    run.press("lock", segment);
    const bool is_locked = comes([&] { return cases::state_of(*run.plan()).arrangement.is_locked(segment); });
    may_end = true;
    REQUIRE(is_locked);
    std::filesystem::path made;
    REQUIRE(comes([&] { return !(made = flap.take_changed()).empty(); }));
    const cases::PlanState state = cases::state_of(cases::load_case_plan(made));
    CHECK(state.reconstruction->flap.margin == 7e-3);
    CHECK(state.arrangement.is_locked(segment));
    bench.stop();
}
