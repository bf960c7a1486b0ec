// SPDX-License-Identifier: Apache-2.0
// The steps of a plan that the patch changes, with undo and redo, and what can be done to the held or chosen fragments.
#pragma once

#include "tools/analysis/beside.hpp"
#include "tools/window/document/case_run.hpp"
#include "tools/window/document/fragment_fits.hpp"
#include "tools/window/document/fragment_mover.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/plan/flap_panel.hpp"
#include "tools/window/plan/plan_alternatives.hpp"
#include "tools/window/plan/plan_map.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/widgets/painter.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
        scene_.use_mover(&mover_);
    }
    ~PlanPanel() {
        bench_.is_settled = nullptr;
        scene_.use_mover(nullptr);
    }
    PlanPanel(const PlanPanel&) = delete;
    PlanPanel& operator=(const PlanPanel&) = delete;

    CaseRun& case_run() { return case_; }
    FragmentMover& mover() { return mover_; }
    /// Once per picture, also while it is not drawn: the scene keeps the colours of a map.
    void tend(const std::shared_ptr<observe::Observer>& observer) {
        case_.tend(observer);
        tend_placing();
        map_.tend();
        alternatives_.tend();
        flap_.tend();
    }
    void draw(const Fonts& fonts);
    /// Once per picture, also while it is not drawn: what a command asks for.
    void draw_questions() {
        alternatives_.draw_question();
        flap_.draw_question();
    }
    /// What its buttons do, by name.
    void add_commands(std::vector<Command>& all);
    /// Once per picture, before the run is looked at: begins the run again when its plan was changed beside it.
    void begin_again();

private:
    /// The fragments that a command means: the chosen ones, or the one that a hand holds or has held last.
    std::vector<int> meant() const;
    void on_meant(const std::function<void(const std::vector<int>&)>& what);
    void group();
    void split();
    void lock();
    void hide();
    void hand_buttons();
    void history_buttons();
    void fit_line() const;
    void fragment_buttons();
    /// Buttons that put the chosen fragment to a place, and the fits to choose from.
    void placing_buttons();
    void candidates();
    void tend_placing();
    void snap();
    void put_back();
    void put_on_mirror();
    void accept();
    void follow_state();
    bool can_place();
    bool has_mirror();
    void show_candidate();
    void end_candidates();
    void studies();
    void maps();
    void step_list();

    Workbench& bench_;
    CaseRun case_;
    FragmentMover mover_{bench_, case_};
    FragmentFits fits_;
    std::optional<FragmentFits::Found> found_;  ///< fits to choose from
    std::size_t candidate_ = 0;
    std::string placed_;  ///< what became of the last request
    /// A command that is computed beside the window, and words about it.
    struct Placing {
        plan::PlanCommand command;
        std::string words;
    };
    analysis::Beside<Placing> placing_;
    std::shared_ptr<const plan::CasePlan> placing_of_;  ///< the plan as it was then, also for `fits_`
    std::int64_t state_version_ = -1;  ///< of the plan that the next two are of
    bool has_mirror_ = false;
    std::optional<fit::Arrangement> arrangement_;
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
