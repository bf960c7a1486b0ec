// SPDX-License-Identifier: Apache-2.0
// Replaces the file of a fragment in a plan by the same bone with corrected paint. Poses and steps are kept.
#pragma once

#include "tools/analysis/plan/plan_case.hpp"

#include <cstddef>
#include <filesystem>

namespace tactus::analysis {

struct Repainted {
    std::size_t faces = 0;  ///< painted faces of the new file; 0: fits that need paint use a proposal
    bool is_compared = false;  ///< with the surface of the old file; false: that is missing or has changed
    plan::PlanStep step;  ///< to be added by the caller
};

/// Returns the step that makes `file` the file of a fragment. `folder`: of the plan. The surfaces of the old and the
/// new file must be equal: at most 2 % of either may be farther than 0.5 mm (and than a voxel) from the other. If the
/// old file is missing or has changed, this cannot be checked, and `is_same_bone` must be true. Throws Error.
Repainted repaint(const plan::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                  const std::filesystem::path& file, bool is_same_bone);

}  // namespace tactus::analysis
