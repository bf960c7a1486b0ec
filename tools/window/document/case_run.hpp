// SPDX-License-Identifier: Apache-2.0
// The plan that a running patch changes, or the opened plan while none runs: its steps, the commands that change it, the
// fit of the held fragment, and studies of it. No user interface.
#pragma once

#include "assets/plan/plan_history.hpp"
#include "engine/observe/observer.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/window/document/live_commands.hpp"
#include "tools/window/document/plan_document.hpp"
#include "tools/window/document/workbench.hpp"

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

/// A step of a plan as it is listed.
struct StepLine {
    int number = 0;
    std::string text;
    bool is_done = true;  ///< false: undone, and can be redone
};
/// The steps on the way to the tip of the current alternative, the first step first.
std::vector<StepLine> step_lines(const plan::CasePlan& plan);

class CaseRun {
    using Clock = std::chrono::steady_clock;

public:
    explicit CaseRun(Workbench& bench) : bench_(bench), commands_(bench) {}
    ~CaseRun();
    CaseRun(const CaseRun&) = delete;
    CaseRun& operator=(const CaseRun&) = delete;

    /// The plan that was opened, to which every version of a run's plan goes; null: none. It must outlive its use.
    void use(PlanDocument* document) { document_ = document; }
    PlanDocument* document() const { return document_; }

    /// Once per picture: follows the patch and the versions of the plan, and sends commands.
    void tend(const std::shared_ptr<observe::Observer>& observer);
    /// The patch has a plan.
    bool is_there() const { return !node_.empty(); }

    /// That of the run as it is now, or the opened one while none runs; null: neither. With absolute paths.
    const plan::CasePlan* plan() const { return plan_.get(); }
    const std::shared_ptr<const plan::CasePlan>& newest() const { return plan_; }
    /// Increases with every version of `plan`; 0: none.
    std::int64_t version() const { return version_; }
    /// The output of the patch that has the fragments, "case.scene".
    std::string scene_port() const { return node_ + ".scene"; }
    /// The name of the plan in the patch's [assets].
    const std::string& asset() const { return asset_; }
    /// The file to which the run writes the plan; without a run that of the opened plan.
    const std::filesystem::path& file() const { return file_; }
    /// Where results of studies go: beside the opened plan, or the run's folder.
    std::filesystem::path folder_of_results() const;
    const std::vector<StepLine>& steps() const { return steps_; }

    /// Applies a command to the plan: in the run, after those that were given before; or to the opened plan at once while
    /// no run changes it. Why one is not done is in the messages.
    void give(const plan::PlanCommand& command);
    /// There is a plan that commands change.
    bool can_give() const { return is_live() || changes_document(); }
    /// Locks fragments, or unlocks them if all are locked.
    void toggle_lock(const std::vector<int>& fragments);
    /// Shows all fragments that the plan hides.
    void show_hidden();
    /// The fragment that a hand holds in the run, or has held last; -1: none.
    int held_last() const { return held_last_; }
    /// The patch runs.
    bool is_live() const;
    /// No run changes the opened plan: commands do so at once.
    bool changes_document() const { return document_ != nullptr && !is_live(); }
    /// True if `plan` contains every change, so a run that starts from it loses none. False while a fragment is held
    /// or the run is paused.
    bool is_settled() const;
    /// What was asked of the plan is not yet in the run.
    bool is_asked() const { return commands_.is_under_way(); }
    /// Before the opened plan is left, at each picture: true while a step that was asked for is not in it yet. A run that
    /// is paused ends first.
    bool brings_what_waits();
    /// The same where no picture follows: what waits is put into the opened plan at once, and the run is left.
    void take_what_waits();
    /// A person holds a fragment: where it is now is no step yet.
    bool is_holding() const;
    /// For a change with which the run is to begin again. False: not now; the reason is in the messages. In a pause they
    /// say that it waits.
    bool may_begin_again();
    /// The button of the hand, 0 to 3, that grasps, asks for a fit ("snap") or settles; none: the hand does not.
    std::optional<std::size_t> hand_button(const std::string& what) const;

    /// What the matcher says of the held fragment; none: there is no matcher.
    struct Fit {
        int fragment = -1, partner = -1, verdict = -1;
        bool fits = false;
        double score = 0.0, rms = 0.0, gap = 0.0, penetration = 0.0;  ///< 0 to 1; m
    };
    std::optional<Fit> fit() const;

    /// A study of the plan, beside the window; one at a time.
    enum class Study { gaps, healthy, report, files };
    void begin(Study study);
    bool is_busy() const { return study_.is_busy(); }
    /// How long the study takes so far, s.
    double busy_s() const { return std::chrono::duration<double>(Clock::now() - study_begun_).count(); }
    /// Ends the study, before it has written anything. An export of many files is not ended.
    bool can_cancel_study() const { return studied_ != Study::files; }
    void cancel_study();
    /// What the last study said; numbers go with the state of the plan of which they are.
    const std::string& found() const { return found_; }

private:
    void follow_patch();
    void watch(const std::shared_ptr<observe::Observer>& observer);
    void look_for_changes();
    void follow_plan();
    void change_document(const plan::PlanCommand& command);
    void do_what_is_left();
    double number(const std::string& port, double otherwise) const;
    bool flag(const std::string& port) const;

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::int64_t plan_version_ = -1;
    std::string node_, matcher_;
    std::string file_name_, asset_;
    std::map<std::string, std::size_t> hand_buttons_;
    std::vector<std::string> watched_;
    LiveCommands commands_;
    std::string holding_, which_;  // ports; of the held fragment
    int held_last_ = -1;
    double steps_done_ = -1.0;
    Clock::time_point stepped_{};
    std::size_t steps_at_start_ = 0;
    bool is_hand_of_person_ = true;
    Clock::time_point unsettled_{};
    std::filesystem::path file_;
    PlanDocument* document_ = nullptr;
    std::shared_ptr<const plan::CasePlan> plan_, of_run_;
    std::optional<plan::ChangedPlan> changed_;  // the document ...
    std::shared_ptr<const plan::CasePlan> changed_of_;  // ... if it is still this version
    std::int64_t version_ = 0;
    std::vector<StepLine> steps_;
    analysis::Beside<std::string> study_;
    Clock::time_point study_begun_{};
    Study studied_ = Study::gaps;
    std::int64_t study_of_ = 0;  // version of the plan
    std::string found_;
    bool has_numbers_ = false;  // `found_` is true of `study_of_` only
};

}  // namespace tactus::window
