// SPDX-License-Identifier: Apache-2.0
// A surgeon's decision that a fragment is where it belongs.
#pragma once

#include "assets/cases/case_plan.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::study {

/// What the decision rests on, and the residual that is recorded with it.
enum class AcceptedBy {
    hand,    ///< the surgeon's eye; residual: median gap between the fragment and its partner
    mirror,  ///< the mirrored healthy side; residual: median distance of the fragment from it
    plan     ///< the planned place of a piece of a reconstruction; residual: how far it lies from there
};

/// m: the sides of a healthy body differ by 1 to 2 mm, so a fragment that is farther from the mirrored side is not there.
inline constexpr double max_mirror_residual = 2e-3;

struct Acceptance {
    std::string partner;
    double residual = 0.0;  ///< m
    double gap = 0.0, penetration = 0.0;  ///< m, between the fragment and its partner
    double facing = 0.0;  ///< m²
};

/// Measures a fragment where it is. `partner`: what it is placed beside; none: the first fragment of what stands, else of
/// the other shown ones. The decision holds until either moves from the other, as a fit does. Throws Error for a hidden
/// fragment or partner; for `mirror` when the plan has no healthy side or the fragment lies farther from it than
/// max_mirror_residual; for `plan` when the fragment is no piece of a reconstruction or not at its place.
Acceptance measure_acceptance(const cases::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                              AcceptedBy by, std::optional<int> partner = {});

/// The step that records it: the fragment stays where it is, and is connected to its partner.
cases::PlanStep step_of(const cases::CasePlan& plan, int fragment, AcceptedBy by, const Acceptance& found);

}  // namespace tactus::study
