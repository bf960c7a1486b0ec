// SPDX-License-Identifier: Apache-2.0
// Mirrors the healthy side of a case, registers it to the main fragment, and compares the other fragments with it.
#pragma once

#include "dsp/fit/gap.hpp"
#include "dsp/fit/mirror.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/planning/plan_case.hpp"

#include <filesystem>
#include <vector>

namespace tactus::study {

struct LaidMirror {
    fit::MirrorFit fit;
    cases::MirrorTarget target;                 ///< as stored in the plan
    std::vector<contact::SurfacePoint> surface;   ///< the mirrored side in the frame of the case
    Pose stands;                         ///< pose of the main fragment
};

/// Mirrors `healthy` (a bone file or mesh) and registers it to fragment `main` of a plan in `folder`. Throws Error.
LaidMirror lay_mirror(const cases::CasePlan& plan, const std::filesystem::path& folder,
                      const std::vector<CaseFragment>& fragments, int main, const std::filesystem::path& healthy);

/// Contact between a fragment and the main one at a pose.
struct FacesThere {
    fit::SurfaceGap gap;
    double overlap = 0.0;  ///< m³
};

/// Compares a fragment with the mirrored side. `stands`: pose of `main`.
struct MirrorComparison {
    fit::Registration registration;
    Motion away;                ///< motion of its centre from the current to the best pose
    FacesThere before, after;
};
MirrorComparison compare_with_mirror(const fit::RegistrationTarget& mirror, const CaseFragment& main,
                                     const Pose& stands, const CaseFragment& other, const Pose& from);

}  // namespace tactus::study
