// SPDX-License-Identifier: Apache-2.0
// Steps of a plan as rows of numbers, which a real-time node can write, and their conversion back.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::plan {

/// Row kind for a move in the history (undo, redo, alternative), which is not a step.
inline constexpr int row_goes_to = 100;
/// Row kinds for alternatives; `after` is an index in the plan's list of alternatives. row_alternative: switches to it,
/// or, with the number of alternatives, starts another one at the current state. row_drop: removes it. row_undrop:
/// restores the one removed last; of more than `max_dropped` the oldest cannot be restored.
inline constexpr int row_alternative = 101, row_drop = 102, row_undrop = 103;
inline constexpr std::size_t max_dropped = 32;

/// One fragment of one step. The rows of a step are consecutive.
struct StepRow {
    double step = 0.0;  ///< number of the step in the plan
    double after = -1.0;  ///< number of the previous step, -1: none. For row_goes_to: the target step
    double kind = 0.0;  ///< a StepKind, or row_goes_to
    double by = 0.0;  ///< 0: by hand, 1: settled at a fit
    double left = 0.0;  ///< remaining rows of this step
    double fragment = 0.0;
    double x = 0.0, y = 0.0, z = 0.0;  ///< m
    double qw = 1.0, qx = 0.0, qy = 0.0, qz = 0.0;
    double other = -1.0;  ///< for a group: the second fragment; for a fit: the partner
    double verdict = -1.0;  ///< a FitVerdict, -1: no fit
    double score = 0.0, margin = 0.0, rms = 0.0, gap = 0.0, penetration = 0.0, overlap = 0.0;

    Pose pose() const { return {{x, y, z}, {qw, qx, qy, qz}}; }
    void set(const Pose& p) {
        x = p.position.x, y = p.position.y, z = p.position.z;
        qw = p.orientation.w, qx = p.orientation.x, qy = p.orientation.y, qz = p.orientation.z;
    }
};
inline constexpr std::size_t step_row_columns = 21;
static_assert(sizeof(StepRow) == step_row_columns * sizeof(double));
extern const std::array<std::string_view, step_row_columns> step_row_names;

/// Collects the rows of a run and adds the steps to its plan.
class RunSteps {
public:
    /// The run starts at the current state of the plan.
    explicit RunSteps(CasePlan plan);

    /// Adds a row; `second` is the time since the start of the run. The step is added to the plan with its last row.
    /// Throws Error for an invalid step, which is skipped.
    void add(const StepRow& row, double second);

    const CasePlan& plan() const { return plan_; }

private:
    void go(int head);
    void switch_to(double place);
    void drop(double place);
    void undrop();
    int head_of(double number, std::size_t count) const;
    void finish_step(double second);

    CasePlan plan_;
    PlanState state_;  // at the head
    std::vector<int> numbers_;  // step numbers in the plan, by step number of the run
    std::vector<StepRow> rows_;  // rows of the incomplete step
    std::vector<PlanAlternative> dropped_;  // in this run, the last one at the end
};

}  // namespace tactus::plan
