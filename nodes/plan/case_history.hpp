// SPDX-License-Identifier: Apache-2.0
// Steps and alternatives of a case during a run, and the rows that record them.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/plan/step_row.hpp"
#include "dsp/fit/arrangement/step_tree.hpp"
#include "graph/node/setup.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace tactus::nodes {

/// Allocates in the constructor only; no other function allocates, waits or throws.
class CaseHistory {
public:
    static constexpr std::size_t max_ways = 32;  ///< alternatives

    explicit CaseHistory(const plan::CasePlan& plan);

    /// Replaces `now` by the previous, or the next, step. Returns false if there is none.
    bool undo(fit::Arrangement& now) noexcept;
    bool redo(fit::Arrangement& now) noexcept;

    /// Switches to an alternative; the number after the last one starts a new alternative at the current state. Returns
    /// false, without a change, if the number is invalid or is the current one.
    bool go_to(std::size_t alternative, fit::Arrangement& now) noexcept;
    /// Removes an alternative; a negative number restores the one removed last, of at most plan::max_dropped. Returns
    /// false if that is not possible.
    bool drop(double number) noexcept;

    /// Records all changes since the last step as a step.
    void add(const fit::Arrangement& now) noexcept;

    /// A row for the next step.
    plan::StepRow row(double kind) const noexcept;
    /// Number of steps up to the current one, and of all steps.
    int done() const noexcept { return tree_.done(); }
    int count() const noexcept { return tree_.count(); }

private:
    fit::StepTree tree_;
    fit::Arrangement kept_;  // after the last step
    std::vector<fit::HistoryPlace> ways_;  // of the alternatives; that of the current one is in the tree
    std::size_t way_ = 0;
    std::vector<fit::HistoryPlace> dropped_;  // the last one at the end
};

}  // namespace tactus::nodes
