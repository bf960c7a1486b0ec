// SPDX-License-Identifier: Apache-2.0
// A cutting guide as a part of a plan.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/reconstruction/reconstruction.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Makes the guide of these settings, with the blade of the plan's kerf and usual sizes, and writes its mesh (STL, mm,
/// LPS) beside the plan as "guide-NAME.stl", or with a number after it where there is one; fills `guide.mesh`. Returns its
/// warnings. `folder`: of the plan. Throws Error like plan_guide, and for a name that no file can have.
[[nodiscard]] std::vector<std::string> make_kept_guide(reconstruction::KeptGuide& guide, const plan::CasePlan& plan,
                                         const std::filesystem::path& folder);

}  // namespace tactus::analysis
