// SPDX-License-Identifier: Apache-2.0
// The alternatives of the plan of a run as a list: go to one, begin another, drop one, and compare two in the scene.
#pragma once

#include "tools/view/plan/case_run.hpp"
#include "tools/view/plan/plan_comparison.hpp"
#include "tools/view/scene/scene_panel.hpp"

#include <array>
#include <future>
#include <string>
#include <vector>

namespace tactus::view {

class PlanAlternatives {
public:
    PlanAlternatives(Workbench& bench, CaseRun& run, ScenePanel& scene) : bench_(bench), run_(run), scene_(scene) {}

    /// Once per picture: what is compared follows the plan.
    void tend();
    void draw();
    /// Draws this one over the current one; empty: none.
    void compare(const std::string& name) { compared_ = name; }

private:
    void list(const cases::CasePlan& plan);

    using Numbers = std::array<AlternativeNumbers, 2>;

    Workbench& bench_;
    CaseRun& run_;
    ScenePanel& scene_;
    std::string compared_, shown_;  ///< names; shown: what the scene has
    std::filesystem::file_time_type of_{};
    std::vector<std::string> differences_;
    std::future<Numbers> counting_;
    std::vector<std::string> numbers_;
};

}  // namespace tactus::view
