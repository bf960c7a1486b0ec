// SPDX-License-Identifier: Apache-2.0
// Designs a plate on the outer contour of a reconstructed jaw.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"

namespace tactus::reconstruction {

struct PlateSettings {
    double width = 7.0e-3, thickness = 2.5e-3;  ///< m (BoneReconstructionPlanner)
    double screw_length = 12e-3, screw_diameter = 2e-3;  ///< m; placeholders, without a source
    int screws_per_segment = 2, screws_per_stump = 3;  ///< at each end of the jaw; placeholders
    double screw_spacing = 8e-3;  ///< m on a stump; a placeholder
    double spacing = 5e-3;        ///< m between points of the centreline
    double height = 0.0;  ///< m by which the centreline lies above (superior to) the segments' axes
};

/// The centreline runs horizontally on the outer side of the segments and, if `inputs` have a jaw, on its stumps beyond
/// the first and last plane. Outer means away from the middle of the jaw. Screws run horizontally into the bone, away
/// from cuts. Throws Error if there is no donor, and if there is no bone on the outer side.
Plate plate_on(const FibulaInputs& inputs, const FibulaPlan& plan, const PlateSettings& settings = {});

}  // namespace tactus::reconstruction
