// SPDX-License-Identifier: Apache-2.0
// Steps of a plan as numbers alone: what a node may write from its tick, and how they become steps again.
#pragma once

#include "assets/cases/case_plan.hpp"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::cases {

/// Where the plan went by itself: not a step, but to one.
inline constexpr int row_goes_to = 100;

/// One fragment of one step. Rows of one step follow each other.
struct StepRow {
    double step = 0.0;    ///< number that the step has in the plan
    double after = -1.0;  ///< number of the step that it follows, -1: none. Of row_goes_to: the one gone to
    double kind = 0.0;    ///< a StepKind, or row_goes_to
    double by = 0.0;      ///< 0: the hand, 1: settled at a fit
    double left = 0.0;    ///< rows of this step that follow
    double fragment = 0.0;
    double x = 0.0, y = 0.0, z = 0.0;              ///< m
    double qw = 1.0, qx = 0.0, qy = 0.0, qz = 0.0;
    double other = -1.0;    ///< of group: the second fragment; of a fit: the partner
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

/// The steps of a run, added to its plan as their rows come.
class RunSteps {
public:
    /// The run begins where the plan stands.
    explicit RunSteps(CasePlan plan);

    /// A row, `second` from the start of the run. The step is in the plan once its last row is there. Throws Error for
    /// what is no step of this plan; it is left out then, and the plan goes on without it.
    void add(const StepRow& row, double second);

    const CasePlan& plan() const { return plan_; }

private:
    void go(int head);
    int head_of(double number, std::size_t count) const;
    void finish_step(double second);

    CasePlan plan_;
    PlanState state_;  // at the head
    std::vector<int> numbers_;  // in the plan, of each number of the run
    std::vector<StepRow> rows_;  // of the step that is not whole yet
};

}  // namespace tactus::cases
