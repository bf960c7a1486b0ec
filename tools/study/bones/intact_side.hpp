// SPDX-License-Identifier: Apache-2.0
// The unbroken bone laid where fragments belong: the healthy side mirrored, or the bone before it broke.
#pragma once

#include "assets/cases/case_plan.hpp"
#include "dsp/fit/registration.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace tactus::study {

struct IntactSide {
    std::vector<contact::SurfacePoint> points;  ///< in the frame of the fragment that it was laid on
    fit::Registration registration;  ///< of that fragment's points to it
};

/// The healthy side of a plan as it lies in the frame of the case; `folder` is the plan's. Throws Error. Whether
/// the file is the one that the plan was made with is for check_files to say.
std::vector<contact::SurfacePoint> laid_target(const cases::MirrorTarget& target, const std::filesystem::path& folder);

/// From a bone file, a CT or a mesh, laid on `main`, from anywhere. Throws Error for a file that has no surface.
IntactSide lay_intact_side(const std::filesystem::path& file, bool mirror, std::span<const contact::SurfacePoint> main);

}  // namespace tactus::study
