// SPDX-License-Identifier: Apache-2.0
// A plan with the bones of its fragments: what a patch takes as one asset.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/plan/case_plan.hpp"

#include <filesystem>
#include <vector>

namespace tactus {

struct CaseBones {
    CasePlan plan;  ///< files as absolute paths, so that the plan can be saved elsewhere
    std::vector<Bone> bones;  ///< one per fragment, none without points; unpainted ones with a proposal
};

/// Reads a plan and its fragments. Throws Error as load_case_plan does, for files that are missing or have changed,
/// and for
/// what import refuses.
CaseBones load_case(const std::filesystem::path& path);

}  // namespace tactus
