// SPDX-License-Identifier: Apache-2.0
// Writes a plan for other programs: placed meshes, ITK transforms, landmarks for 3D Slicer.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct ExportedFragment {
    std::string name;
    Pose pose;
    std::vector<std::string> files;  ///< in the folder
};

struct ExportedPlan {
    /// The exported shown fragments. A reconstruction has an entry of that name, with its markups (flap_export.hpp);
    /// the vessels of a case have one named "vessels", in the frame of the scan.
    std::vector<ExportedFragment> written;
    std::vector<std::string> left_out;  ///< names of the hidden fragments
};

/// `folder`: of the plan; `out`: is created; `format`: "stl" or "ply"; `transform_format`: "tfm" or "h5". Throws Error, also if
/// all fragments are hidden.
ExportedPlan export_plan(const plan::CasePlan& plan, const std::filesystem::path& folder,
                         const std::filesystem::path& out, const std::string& format,
                         const std::string& transform_format = "tfm");

}  // namespace tactus::analysis
