// SPDX-License-Identifier: Apache-2.0
// Another file for a fragment of a plan: the same bone with corrected paint. Poses and steps stay.
#pragma once

#include "tools/study/planning/plan_case.hpp"

#include <cstddef>
#include <filesystem>

namespace tactus::study {

struct Repainted {
    std::size_t faces = 0;  ///< painted faces of the file that is taken; 0: where a fit needs paint it is proposed
    bool is_compared = false;  ///< with the surface of the file before; else that file is gone or has changed
    cases::PlanStep step;  ///< for the caller to add
};

/// The step that makes `file` the file of a fragment. `folder`: of the plan. The surface must be that of
/// the file before: at most 2 % of it, and of that, may lie farther than 0.5 mm (and than a voxel) from the other. When
/// the file before is gone or has changed, nothing shows that, and `is_same_bone` must be said. Throws Error.
Repainted repaint(const cases::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                  const std::filesystem::path& file, bool is_same_bone);

}  // namespace tactus::study
