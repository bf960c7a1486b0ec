// SPDX-License-Identifier: Apache-2.0
// The plan of a run on disk: every step soon after it was done.
#pragma once

#include "assets/cases/plan_lock.hpp"
#include "assets/cases/step_row.hpp"
#include "dsp/core/time.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tactus::cases {

/// Adds the steps of a run to a plan file. What the file held before is moved aside when the run does not continue it:
/// "case.plan.json.1", the next free number.
class PlanKeeper {
public:
    /// Writes the plan as the run finds it. Throws Error when that is not possible, before anything was done.
    PlanKeeper(CasePlan plan, std::filesystem::path file);

    void add(const StepRow& row, double second);
    /// The file holds all steps when it returns, or what it held before; throws Error then, and may be called again.
    void save();
    /// The last `save`. When there is still no room for the file, the plan goes to the folder of temporary files and the
    /// Error says where.
    void finish();

    /// What was no step of the plan and was left out; empty: nothing.
    const std::string& trouble() const { return trouble_; }

private:
    void move_old_aside();

    std::filesystem::path file_;
    PlanLock lock_;
    RunSteps steps_;
    bool is_saved_ = false;
    std::string trouble_;
};

}  // namespace tactus::cases
