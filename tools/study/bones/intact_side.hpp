// SPDX-License-Identifier: Apache-2.0
// The unbroken bone laid where fragments belong: the healthy side mirrored, or the bone before it broke.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "dsp/planning/registration.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace tactus::study {

struct IntactSide {
    std::vector<SurfacePoint> points;  ///< in the frame of the fragment that it was laid on
    Registration registration;  ///< of that fragment's points to it
};

/// The healthy side of a plan as it lies in the frame of the case; `folder` is the plan's. Throws Error. Whether
/// the file is the one that the plan was made with is for check_files to say.
std::vector<SurfacePoint> laid_target(const MirrorTarget& target, const std::filesystem::path& folder);

/// From a bone file, a CT or a mesh, laid on `main`, from anywhere. Throws Error for a file that has no surface.
IntactSide lay_intact_side(const std::filesystem::path& file, bool mirror, std::span<const SurfacePoint> main);

}  // namespace tactus::study
