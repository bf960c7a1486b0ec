// SPDX-License-Identifier: Apache-2.0
// A plan with the bones of its fragments: what a patch takes as one asset.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/cases/case_plan.hpp"
#include "dsp/core/jobs.hpp"

#include <filesystem>
#include <vector>

namespace tactus::cases {

/// A bone file ("FILE.vdb#NAME" for one of several), or what import makes of a mesh or a CT. Throws Error.
bone::Bone bone_from_file(const std::filesystem::path& path, const RunJobs& run = run_in_turn);

/// Where no paint is filed, it may be proposed.
enum class Paint { as_filed, or_proposed };

struct FragmentBone {
    bone::Bone bone;                 ///< with points
    bool was_painted = false;  ///< in its file
};

/// The bone of a fragment. Throws Error naming the fragment.
FragmentBone fragment_bone(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint,
                           const RunJobs& run = run_in_turn);

/// Throws Error for the first file that is missing or is not the one that the plan was made with.
void check_files(const CasePlan& plan, const std::filesystem::path& folder);

struct CaseBones {
    CasePlan plan;            ///< files as absolute paths, so that the plan can be saved elsewhere
    std::vector<bone::Bone> bones;  ///< one per fragment, none without points; unpainted ones with a proposal
};

/// Reads a plan and its fragments. Throws Error as load_case_plan and check_files do, and for what import refuses.
CaseBones load_case(const std::filesystem::path& path);

}  // namespace tactus::cases
