// SPDX-License-Identifier: Apache-2.0
// A plate on the outer contour of a reconstructed jaw.
#pragma once

#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/flap.hpp"

namespace tactus::reconstruct {

struct PlateSettings {
    double width = 7.0e-3, thickness = 2.5e-3;  ///< m (BoneReconstructionPlanner)
    double screw_length = 12e-3, screw_diameter = 2e-3;  ///< m; placeholders, not from a source
    int screws_per_segment = 2, screws_per_stump = 3;  ///< at each end that the jaw has; placeholders
    double screw_spacing = 8e-3;  ///< m on a stump; a placeholder
    double spacing = 5e-3;        ///< m between points of the centreline
    double height = 0.0;  ///< m by which the centreline lies above (superior) the segments' axes
};

/// The centreline runs on the outside of the segments and, where `inputs` have a jaw, on its stumps beyond the first and
/// last plane: away from the middle of the jaw, level. Screws go level into the bone, away from cuts. Throws Error when
/// there is no donor, and when the outside has no bone.
Plate plate_on(const FibulaInputs& inputs, const FibulaPlan& plan, const PlateSettings& settings = {});

}  // namespace tactus::reconstruct
