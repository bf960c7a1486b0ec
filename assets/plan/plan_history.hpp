// SPDX-License-Identifier: Apache-2.0
// The arrangement of a plan with its tree of steps and its alternatives, as commands change it. A run applies commands
// within a tick, the plan file and the window outside of one, both by `PlanHistory::apply`.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/plan/plan_command.hpp"
#include "dsp/fit/arrangement/step_tree.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::plan {

/// Allocates in the constructor only; no other function allocates, waits or throws.
class PlanHistory {
public:
    static constexpr std::size_t max_alternatives = 32;
    /// Of more dropped alternatives the oldest cannot be restored.
    static constexpr std::size_t max_dropped = 32;
    /// Smaller motions are ignored: grasping and releasing a fragment adds no step.
    static constexpr double min_distance = 1e-6;  ///< m, of the origin of the fragment's file
    static constexpr double min_angle = 1e-6;     ///< rad

    /// Starts at the current state of the plan.
    explicit PlanHistory(const CasePlan& plan);

    enum class Outcome : std::uint8_t {
        done,
        unchanged,  ///< the command would change nothing
        locked,  ///< a locked fragment moves together with the one to be moved
        no_such_fragment,  ///< or its pose is not valid
        too_far,  ///< see is_near
        no_such_group,
        nothing_to_undo,
        nothing_to_redo,
        no_such_alternative,
        too_many_alternatives,
    };
    /// If the outcome is not `done`, nothing has changed.
    Outcome apply(const PlanCommand& command) noexcept;

    const fit::Arrangement& now() const noexcept { return now_; }
    fit::HistoryPlace place() const noexcept { return tree_.place(); }
    /// Place of the current alternative, and number of all.
    std::size_t alternative() const noexcept { return alternative_; }
    std::size_t alternatives() const noexcept { return alternatives_.size(); }
    /// Number of steps up to the current one, and of all steps.
    int done() const noexcept { return tree_.done(); }
    int count() const noexcept { return tree_.count(); }

private:
    struct Apply;
    Outcome add_step() noexcept;
    Outcome go_to(std::size_t alternative) noexcept;
    Outcome drop(std::size_t alternative) noexcept;
    Outcome restore() noexcept;
    bool has(int fragment) const noexcept { return fragment >= 0 && fragment < static_cast<int>(now_.size()); }

    fit::StepTree tree_;
    fit::Arrangement now_, before_;  // before_: after the last step, while a command is applied
    std::vector<fit::HistoryPlace> alternatives_;  // that of the current one is in the tree
    std::size_t alternative_ = 0;
    std::vector<fit::HistoryPlace> dropped_;  // the last one at the end
};

/// Reason why a command was not done, for users.
std::string_view text_of(PlanHistory::Outcome outcome);

/// What a step states besides what its command does.
struct StepWords {
    std::string by{};  ///< see PlanStep; empty: "settle" for a fit of fractures, otherwise "hand"
    std::optional<double> run_second{};  ///< s, since the start of the run
    std::string time{};  ///< as in PlanStep
    std::string name{};  ///< of the group or the alternative that the command begins; empty: a free one
};

/// A plan that commands change: their steps with names, fits and times, beside the history that applied them.
class ChangedPlan {
public:
    explicit ChangedPlan(CasePlan plan);

    /// If the outcome is not `done`, the plan is unchanged. Throws Error, without a change, for a name that is taken.
    PlanHistory::Outcome apply(const PlanCommand& command, const StepWords& words = {});

    const CasePlan& plan() const { return plan_; }

private:
    PlanStep step_of(const PlanCommand& command, const fit::Arrangement& before, const std::string& name) const;
    void follow_alternatives(const PlanCommand& command, const std::string& name);
    std::string free_name() const;

    CasePlan plan_;
    PlanState state_;  // at the head
    PlanHistory history_;
    std::vector<PlanAlternative> dropped_;  // the last one at the end
};

/// The same for one command.
[[nodiscard]] PlanHistory::Outcome change(CasePlan& plan, const PlanCommand& command, const StepWords& words);

}  // namespace tactus::plan
