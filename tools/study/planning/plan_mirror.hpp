// SPDX-License-Identifier: Apache-2.0
// The healthy side of a plan's case: mirrored, laid on the main fragment, and the others compared with it.
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
    cases::MirrorTarget target;                 ///< as the plan keeps it
    std::vector<contact::SurfacePoint> surface;   ///< the mirrored side where it lies in the case
    Pose stands;                         ///< of the main fragment
};

/// Lays `healthy`, a bone file or mesh, mirrored on fragment `main` of a plan in `folder`. Throws Error.
LaidMirror lay_mirror(const cases::CasePlan& plan, const std::filesystem::path& folder,
                      const std::vector<CaseFragment>& fragments, int main, const std::filesystem::path& healthy);

/// What a place means for the fracture between a fragment and the main one.
struct FacesThere {
    fit::SurfaceGap gap;
    double overlap = 0.0;  ///< m³
};

/// A fragment beside the mirrored side. `main` stands at `stands`.
struct MirrorComparison {
    fit::Registration registration;
    Motion away;                ///< of its middle, from where it lies to where it lies best
    FacesThere before, after;
};
MirrorComparison compare_with_mirror(const fit::RegistrationTarget& mirror, const CaseFragment& main,
                                     const Pose& stands, const CaseFragment& other, const Pose& from);

}  // namespace tactus::study
