// SPDX-License-Identifier: Apache-2.0
// The alternatives of the plan of a run as a list: go to one, begin another, drop one, and compare two in the scene.
#pragma once

#include "tools/analysis/beside.hpp"
#include "tools/window/document/case_run.hpp"
#include "tools/window/plan/plan_comparison.hpp"
#include "tools/window/scene/scene_panel.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

class PlanAlternatives {
public:
    PlanAlternatives(Workbench& bench, CaseRun& run, ScenePanel& scene) : bench_(bench), run_(run), scene_(scene) {}

    /// Once per picture: what is compared follows the plan.
    void tend();
    void draw();
    /// Draws this one over the current one; empty: none.
    void compare(const std::string& name) { compared_ = name; }

    /// Asks for another name of the current one, in a field of its own: the list may be hidden.
    void ask_name();
    /// Once per picture, also while the list is hidden.
    void draw_question();
    void rename(const std::string& name, const std::string& wanted);
    /// The plan with another name, which a new run begins with; empty: none, or the run has not written yet what was done
    /// before. Taken once.
    std::filesystem::path take_changed();

private:
    void list(const plan::CasePlan& plan);
    /// Places change with what was asked for before.
    bool waits_for_list() const;
    void note_asked();
    void go_to(int place);
    void drop(int place);
    void ask_name(int place, const std::string& name);
    void name_field(int place);

    using Numbers = std::array<AlternativeNumbers, 2>;

    Workbench& bench_;
    CaseRun& run_;
    ScenePanel& scene_;
    std::string compared_, shown_;  ///< names; shown: what the scene has
    std::int64_t of_ = 0;
    std::vector<std::string> differences_;
    analysis::Beside<Numbers> counting_;
    std::vector<std::string> numbers_;
    std::pair<std::string, std::string> wanted_name_;  ///< of the alternative that gets another one, and that
    std::int64_t asked_of_ = 0;  ///< the plan of which the last press was
    double asked_at_ = -1e9;
    int renamed_ = -1;  ///< place of the alternative whose name is asked for
    bool wants_focus_ = false, wants_question_ = false;
    std::string name_;
};

}  // namespace tactus::window
