// SPDX-License-Identifier: Apache-2.0
// Steps of a plan as numbers alone: what a node may write from its tick, and what its record is read back from.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace tactus {

/// Where the plan went by itself: not a step, but to one.
inline constexpr int row_goes_to = 100;

/// One fragment of one step. Rows of one step follow each other.
struct StepRow {
    double step = 0.0;    ///< number of the step, counted from 0 in the run
    double after =
        -1.0;  ///< the step of the run that it follows; -1: where the plan stood before. Of row_goes_to: the head
    double kind = 0.0;    ///< a StepKind, or row_goes_to
    double by = 0.0;      ///< 0: the hand, 1: settled at a fit
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
inline constexpr std::size_t step_row_columns = 20;
static_assert(sizeof(StepRow) == step_row_columns * sizeof(double));
extern const std::array<std::string_view, step_row_columns> step_row_names;

/// Adds the steps of a run to its plan, their time counted in `seconds` from its start, one per row. Throws Error at the
/// first row that is no step of this plan; the steps before it are in the plan then.
void apply_steps(CasePlan& plan, std::span<const StepRow> rows, std::span<const double> seconds);

/// Reads what 'record' wrote of a run: a CSV file, complete or as a crash left it. `seconds` gets the time of each row.
/// Throws Error for files that hold something else.
std::vector<StepRow> read_step_rows(const std::filesystem::path& path, std::vector<double>& seconds);

}  // namespace tactus
