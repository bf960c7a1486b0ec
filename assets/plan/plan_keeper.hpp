// SPDX-License-Identifier: Apache-2.0
// Keeps the plan file of a run up to date.
#pragma once

#include "assets/plan/plan_history.hpp"
#include "assets/plan/plan_lock.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace tactus::plan {

/// Applies the commands of a run to a plan file. When the run does not continue the existing plan, the old file is renamed
/// to "case.plan.json.1", or the next free number.
class PlanKeeper {
public:
    /// Writes the plan at the start of the run. Throws Error when it cannot be written.
    PlanKeeper(CasePlan plan, std::filesystem::path file);

    void add(const PlanRecord& record, double second);
    /// Saves all steps. On failure the file keeps its content and Error is thrown; the call may be repeated.
    void save();
    /// The last `save`. If the file still cannot be written, the plan is saved to the temporary folder and the Error
    /// contains that path.
    void finish();

    /// The plan with all steps so far, also those that could not be saved.
    const CasePlan& plan() const { return changed_.plan(); }
    /// Describes commands that were lost on their way or could not be applied; empty: none.
    const std::string& trouble() const { return trouble_; }

private:
    void move_old_aside();

    std::filesystem::path file_;
    PlanLock lock_;
    ChangedPlan changed_;
    std::int64_t next_ = 0;
    bool is_saved_ = false;
    std::string trouble_;
};

}  // namespace tactus::plan
