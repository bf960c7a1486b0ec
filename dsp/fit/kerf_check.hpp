// SPDX-License-Identifier: Apache-2.0
// Whether two placed halves are as far apart as the outer contour of the cortex beyond their faces says.
//
// Both halves were one bone: its surface goes on across the gap. Halves that are too far apart or too near to each
// other along the normal of an oblique break have a step there, of n·ν times the error at a contour with the normal ν.
// Strips of cortex across the gap, from both halves, give the step; what they do not share is their spread. A square
// break through a prism leaves no step however wide it gapes: the estimate then has a spread that says so.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/fit/fit_surface.hpp"

#include <span>

namespace tactus::fit {

/// One half: its whole surface, and the face that lies on the other half.
struct KerfSide {
    std::span<const contact::SurfacePoint> points;
    const FitSurface* face = nullptr;
};

struct ContourOpening {
    double excess = 0.0;  ///< m along the opening: by how much the halves are farther apart than the contour says
    double spread = 1.0;  ///< m, standard deviation of `excess`; large when the contour says nothing
    int strips = 0;  ///< that were found on both halves
};

/// `pose`: of the moving half in the frame of the fixed one. For preparations, not for a tick: it allocates.
ContourOpening contour_opening(const KerfSide& moving, const KerfSide& fixed, const Pose& pose);

/// The kerf that the contour says, beside the one that was told (0: none was).
struct KerfEstimate {
    double told = 0.0, kerf = 0.0, spread = 0.0;  ///< m, mean width, as FitSettings::kerf has it
    /// With the kerf that the contour says, the halves would lie more than half a millimetre elsewhere. A contour whose
    /// opening is not known to a millimetre contradicts nobody; where no kerf was told, it must say more than half of
    /// `spread`.
    bool is_contradicted = false;
    /// No kerf was told, and the contour does not exclude that half a millimetre is lost: what it says and half of
    /// `spread` are together more. Never where there is no contour.
    bool is_open = false;
    /// Rough faces are between `told` and told / (mean cosine of their slopes) apart along the opening: that leaves
    /// more than half a millimetre.
    bool is_too_wide = false;

    bool is_doubtful() const noexcept { return is_contradicted || is_open || is_too_wide; }
};

/// Of two halves that were fitted with this kerf (m).
KerfEstimate check_kerf(const KerfSide& moving, const KerfSide& fixed, const Pose& pose, double told);

}  // namespace tactus::fit
