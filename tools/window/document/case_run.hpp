// SPDX-License-Identifier: Apache-2.0
// The plan that a running patch changes: its steps, the buttons that are wired to its case_scene node, the fit of the held
// fragment, and studies of it. No user interface.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "engine/observe/observer.hpp"
#include "tools/window/document/live_commands.hpp"
#include "tools/window/document/workbench.hpp"

#include <chrono>
#include <filesystem>
#include <future>
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

/// A file that is not there, for a plan that was changed beside its run: "changed-1.plan.json" and so on.
std::filesystem::path free_plan(const std::filesystem::path& folder);

class CaseRun {
public:
    explicit CaseRun(Workbench& bench) : bench_(bench), commands_(bench) {}
    ~CaseRun();
    CaseRun(const CaseRun&) = delete;
    CaseRun& operator=(const CaseRun&) = delete;

    /// Once per picture: follows the patch and the plan's file, and sends commands.
    void tend(const std::shared_ptr<observe::Observer>& observer);
    /// The patch has a plan.
    bool is_there() const { return !node_.empty(); }

    /// As the run last wrote it; null until then.
    const plan::CasePlan* plan() const { return plan_ ? &*plan_ : nullptr; }
    /// The name of the plan in the patch's [assets].
    const std::string& asset() const { return asset_; }
    const std::filesystem::path& file() const { return file_; }
    /// When it was written.
    std::filesystem::file_time_type written() const { return written_; }
    const std::vector<StepLine>& steps() const { return steps_; }

    /// Presses the button node that is wired to an input of the plan: "undo", "redo", "join", "split", "lock", "hide",
    /// "show". `fragment`, `other`: places that it means; −1: the fragment held last, and its partner.
    void press(const std::string& input, int fragment = -1, int other = -1);
    /// A button node is wired to that input, and the patch runs.
    bool can_press(const std::string& input) const;
    /// Puts fragments into one group, one after another.
    void join(const std::vector<int>& fragments);
    /// The patch runs.
    bool is_live() const;
    /// All that was done to the plan has come into its file: a run that begins with that file loses nothing. False while
    /// a fragment is held or the run is paused.
    bool is_settled() const;
    /// What was asked of the plan is not yet in the run.
    bool is_asked() const { return commands_.is_under_way(); }
    /// A person holds a fragment: where it is now is no step yet.
    bool is_holding() const;
    /// For a change with which the run is to begin again. False: not now; the reason is in the messages. In a pause they
    /// say that it waits.
    bool may_begin_again();
    /// Reads the plan's file if it has changed.
    void read_plan();
    /// Goes to an alternative of the plan, by its place; their number: begins another one at the current state.
    void go_to_alternative(int place);
    /// Drops an alternative that is not the current one; -2: brings the last one back.
    void drop_alternative(int place);
    /// The button of the hand, 0 to 3, that grasps, asks for a fit ("snap") or settles; none: the hand does not.
    std::optional<std::size_t> hand_button(const std::string& what) const;

    /// What the matcher says of the held fragment; none: there is no matcher.
    struct Fit {
        int fragment = -1, partner = -1, verdict = -1;
        bool fits = false;
        double score = 0.0, rms = 0.0, gap = 0.0, penetration = 0.0;  ///< 0 to 1; m
    };
    std::optional<Fit> fit() const;

    /// A study of the plan's file, on a thread of its own; one at a time.
    enum class Study { gaps, healthy, report, files };
    void begin(Study study);
    bool is_busy() const { return study_.valid(); }
    /// What the last study said; numbers go with the state of the plan of which they are.
    const std::string& found() const { return found_; }

private:
    using Clock = std::chrono::steady_clock;
    void follow_patch();
    void watch(const std::shared_ptr<observe::Observer>& observer);
    void look_for_changes();
    double number(const std::string& port, double otherwise) const;
    bool flag(const std::string& port) const;

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::int64_t plan_version_ = -1;
    std::string node_, matcher_;
    std::string file_name_, asset_;
    std::map<std::string, std::string> buttons_;  // node, by input
    std::map<std::string, std::size_t> hand_buttons_;
    std::vector<std::string> watched_;
    LiveCommands commands_;
    std::string holding_, which_;  // ports; of the held fragment
    double steps_done_ = -1.0;
    Clock::time_point stepped_{};
    std::size_t steps_at_start_ = 0;
    bool is_hand_of_person_ = true;
    Clock::time_point unsettled_{}, looked_{};
    std::filesystem::path file_;
    std::filesystem::file_time_type written_{}, unread_{};  // unread: of a file that could not be read
    std::optional<plan::CasePlan> plan_;
    std::vector<StepLine> steps_;
    std::future<std::string> study_;
    Study studied_ = Study::gaps;
    std::filesystem::file_time_type study_of_{};
    std::string found_;
    bool has_numbers_ = false;  // `found_` is true of `study_of_` only
};

}  // namespace tactus::window
