// SPDX-License-Identifier: Apache-2.0
// Registers the unbroken bone (the mirrored healthy side, or an earlier scan) to fragments.
#pragma once

#include "assets/cases/case_plan.hpp"
#include "dsp/fit/registration.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace tactus::study {

struct IntactSide {
    std::vector<contact::SurfacePoint> points;  ///< in the frame of the fragment it is registered to
    fit::Registration registration;  ///< registration of that fragment's points to it
};

/// The healthy side of a plan in the frame of the case; `folder` is the plan's folder. Throws Error. Does not check
/// whether the file has changed; see check_files.
std::vector<contact::SurfacePoint> laid_target(const cases::MirrorTarget& target, const std::filesystem::path& folder);

/// Loads a bone file, a CT or a mesh and registers it to `main` from any position. Throws Error for a file without
/// surface.
IntactSide lay_intact_side(const std::filesystem::path& file, bool mirror, std::span<const contact::SurfacePoint> main);

}  // namespace tactus::study
