// SPDX-License-Identifier: Apache-2.0
// A plan that a run of the library changes, as the window has it, without one.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/virtual_clock.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/case_run.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::test {

struct PlanRig {
    VirtualClock clock;
    Folder folder;
    window::Workbench bench;
    window::CaseRun run{bench};
    std::function<void()> also;  ///< once per picture

    /// The hand of the patch takes nothing unless the settings say so.
    explicit PlanRig(const std::string& patch, double dilate = 1.0,
                     const std::vector<std::string>& settings = {"grasp.fixed=16"})
        : bench(choice(patch, dilate, settings)) {
        bench.run();
        REQUIRE(comes([&] { return run.plan() != nullptr; }));
    }
    ~PlanRig() { bench.stop(); }
    PlanRig(const PlanRig&) = delete;
    PlanRig& operator=(const PlanRig&) = delete;

    void picture() {
        bench.tend();
        run.tend(bench.observer());
        if (also) also();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    template <class What>
    bool comes(What what, int pictures = 6000) {
        for (int i = 0; i < pictures; ++i) {
            picture();
            if (what()) return true;
        }
        return false;
    }
    void pictures(int count) {
        comes([] { return false; }, count);
    }
    bool pause(bool wanted) {
        bench.pause(wanted);
        const auto state = wanted ? window::RunStatus::State::stands : window::RunStatus::State::runs;
        return comes([&] { return bench.status()->state == state; });
    }
    bool is_locked(int fragment) const { return plan::state_of(*run.plan()).arrangement.is_locked(fragment); }
    bool has_told(const std::string& words) const {
        return std::ranges::any_of(bench.messages(),
                                   [&](const window::Message& m) { return m.text.find(words) != std::string::npos; });
    }

private:
    window::RunChoice choice(const std::string& patch, double dilate, const std::vector<std::string>& settings) const {
        window::RunChoice choice;
        choice.patch = (library_folder() / "patches" / (patch + ".toml")).string();
        choice.out = folder.path / "out";
        choice.audio = "none";
        choice.json = true;
        choice.dilate = dilate;
        choice.overrides.settings = settings;
        return choice;
    }
};

}  // namespace tactus::test
