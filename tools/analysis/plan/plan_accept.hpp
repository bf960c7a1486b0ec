// SPDX-License-Identifier: Apache-2.0
// A surgeon's decision that the pose of a fragment is correct.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/plan/plan_command.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::analysis {

/// m: the sides of a healthy body differ by 1 to 2 mm, so that a fragment farther from the mirrored side is misplaced.
inline constexpr double max_mirror_residual = 2e-3;

struct Acceptance {
    std::string partner;
    /// m. By hand, visual judgement: median gap to its partner; if nothing faces it, depth or distance. By mirror: median
    /// distance of the fragment from the mirrored healthy side. By plan: distance from the planned pose of a piece.
    double residual = 0.0;
    double gap = 0.0, penetration = 0.0;  ///< m, between the fragment and its partner
    double facing = 0.0;  ///< m²
    double apart = 0.0;  ///< m: distance of the surfaces if nothing faces the fragment within 3 mm, to about 1 mm
};

/// Measures a fragment at its current pose. `partner`: the fragment beside it; none: of the fixed part, otherwise of the
/// other shown fragments, the one that faces it over the largest area, or the nearest if none faces it. The decision
/// holds until either moves from the other, like a fit. `by`: not fracture. Throws Error for a hidden fragment or partner; for `mirror` if
/// the plan has no healthy side or the fragment is farther from it than max_mirror_residual; for `plan` if the fragment
/// is not a piece of a reconstruction or not at its planned pose.
Acceptance measure_acceptance(const plan::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                              plan::FitBasis by, std::optional<int> partner = {});

/// The command that records it: the fragment keeps its pose and is connected to its partner.
plan::SettleFragment accepting(const plan::CasePlan& plan, int fragment, plan::FitBasis by, const Acceptance& found);

}  // namespace tactus::analysis
