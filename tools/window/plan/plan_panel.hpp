// SPDX-License-Identifier: Apache-2.0
// The steps of a plan that the patch changes, with undo and redo, and what can be done to the held or chosen fragments.
#pragma once

#include "tools/window/document/case_run.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/plan/flap_panel.hpp"
#include "tools/window/plan/plan_alternatives.hpp"
#include "tools/window/plan/plan_map.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

class PlanPanel {
public:
    PlanPanel(Workbench& bench, ScenePanel& scene)
        : bench_(bench),
          case_(bench),
          scene_(scene),
          map_(bench, case_, scene),
          alternatives_(bench, case_, scene),
          flap_(bench, case_, scene) {
        bench_.is_settled = [this] { return may_change_hand(); };
    }
    ~PlanPanel() { bench_.is_settled = nullptr; }
    PlanPanel(const PlanPanel&) = delete;
    PlanPanel& operator=(const PlanPanel&) = delete;

    CaseRun& case_run() { return case_; }
    /// Once per picture, also while it is not drawn: the scene keeps the colours of a map.
    void tend(const std::shared_ptr<observe::Observer>& observer) {
        case_.tend(observer);
        map_.tend();
        alternatives_.tend();
        flap_.tend();
    }
    void draw(const Fonts& fonts);
    /// Once per picture, also while it is not drawn: what a command asks for.
    void draw_questions() { alternatives_.draw_question(); }
    /// What its buttons do, by name.
    void add_commands(std::vector<Command>& all);
    /// Once per picture, before the run is looked at: begins the run again when its plan was changed beside it.
    void begin_again();

private:
    void on_chosen(const char* input);
    void hand_buttons();
    void history_buttons();
    void fit_line() const;
    void fragment_buttons();
    void studies();
    void maps();
    void step_list();

    Workbench& bench_;
    CaseRun case_;
    ScenePanel& scene_;
    PlanMap map_;
    PlanAlternatives alternatives_;
    FlapPanel flap_;
    bool may_change_hand();
    bool waits_to_begin_again();

    std::size_t listed_ = 0;
    bool has_told_to_let_go_ = false, wants_to_begin_again_ = false;
};

}  // namespace tactus::window
