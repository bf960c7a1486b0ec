// SPDX-License-Identifier: Apache-2.0
// A plan together with the bones of its fragments. A patch loads it as one asset.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/plan/case_plan.hpp"
#include "assets/plan/kept_bone.hpp"
#include "assets/plan/kept_result.hpp"
#include "dsp/core/jobs.hpp"

#include <filesystem>
#include <vector>

namespace tactus::plan {

/// Loads a bone file ("FILE.vdb#NAME" for one of several), or imports a mesh or a CT. Throws Error.
/// Imported meshes are cached (kept_bone.hpp).
bone::Bone bone_from_file(const std::filesystem::path& path, const RunJobs& run = run_in_turn,
                          Contents contents = Contents::all);

/// The key of points that are sampled on the surface of a file and cached (kept_points.hpp).
ResultKey key_of_points(const std::filesystem::path& path);

/// `or_proposed`: proposes paint if the file has none.
enum class Paint { as_filed, or_proposed };

struct FragmentBone {
    bone::Bone bone;                 ///< with points
    bool was_painted = false;  ///< the paint comes from the file
};

/// Loads the bone of a fragment. Throws Error naming the fragment.
FragmentBone fragment_bone(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint,
                           const RunJobs& run = run_in_turn, Contents contents = Contents::all);

/// Throws Error for the first file that is missing or has changed since the plan was made.
void check_files(const CasePlan& plan, const std::filesystem::path& folder);

struct CaseBones {
    CasePlan plan;            ///< with absolute paths, so that it can be saved in another folder
    std::vector<bone::Bone> bones;  ///< one per fragment, with points; unpainted bones get proposed paint
};

/// Reads a plan and its fragments. Throws Error like load_case_plan, check_files and import.
CaseBones load_case(const std::filesystem::path& path);

}  // namespace tactus::plan
