// SPDX-License-Identifier: Apache-2.0
// A rig's whole matrix, and what follows from it.
#pragma once

#include "dsp/core/jobs.hpp"
#include "tools/study/grippers/rig_report.hpp"

#include <functional>

namespace tactus::study {

/// Runs every cell of the matrix on a patch, the crossovers and findings over all that is assumed, and the comparison
/// with feed-forward. `progress` is told how many of how many cells are done, from any thread, one at a time. `keep` is
/// given the series of each row, in order. Throws Error.
RigReport study_rig(const session::PatchChoice& choice, const RigMatrix& matrix, const RunJobs& run,
                    const std::function<void(int done, int of)>& progress,
                    const std::function<void(const RigCell&, const control::RigSeries&)>& keep);

/// The same from what was recorded.
RigReport study_rig_series(const std::vector<std::pair<RigCell, control::RigSeries>>& records);

}  // namespace tactus::study
