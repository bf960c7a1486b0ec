// SPDX-License-Identifier: Apache-2.0
// Osteotomies from segments that were placed by hand: place first, then derive the cuts (Olsson 2015, 6.1.3).
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"

#include <span>
#include <vector>

namespace tactus::reconstruction {

struct PlacedCuts {
    FibulaInputs inputs;  ///< with surfaces, if the given ones have them
    FibulaPlan plan;  ///< of these inputs
    /// Of each segment, between where it was placed and where the new plan has it: m at its middle, and rad. They are 0
    /// if the axes of neighbouring segments meet.
    std::vector<double> moved, turned;
    bool is_spaced_anew = false;  ///< the placed parts of the donor overlapped, so that other parts of it are used
};

/// Returns the plan whose segments lie where they were placed, as closely as cuts that close all joints allow. `placed`:
/// pose of each segment of `planned`, donor to jaw. The cuts of the jaw keep their planes. Each joint lies where the axes
/// of its two segments are nearest to each other, and its plane bisects their angle; below 10° the axes determine that
/// point poorly, and it lies between the two faces instead. The roll of each segment and its part of the donor are those
/// of the placed piece. Throws Error for an axis along a cut of the jaw, and as plan_fibula.
PlacedCuts cuts_of_placed(const FibulaInputs& planned_inputs, const FibulaPlan& planned, std::span<const Pose> placed);

}  // namespace tactus::reconstruction
