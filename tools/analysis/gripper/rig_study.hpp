// SPDX-License-Identifier: Apache-2.0
// Runs a test matrix on the gripper's test rig and evaluates it.
#pragma once

#include "dsp/core/jobs.hpp"
#include "tools/analysis/gripper/rig_report.hpp"

#include <functional>

namespace tactus::analysis {

/// Runs every cell of the matrix on a patch, evaluates crossovers and findings over all assumptions, and compares with
/// feed-forward. Calls `progress` with the numbers of finished and of all cells, from any thread, one call at a time.
/// Calls `keep` with the series of each row, in order. Throws Error.
RigReport study_rig(const run::PatchChoice& choice, const RigMatrix& matrix, const RunJobs& run,
                    const std::function<void(int done, int of)>& progress,
                    const std::function<void(const RigCell&, const control::RigSeries&)>& keep);

/// The same from recorded series.
RigReport study_rig_series(const std::vector<std::pair<RigCell, control::RigSeries>>& records);

}  // namespace tactus::analysis
