// SPDX-License-Identifier: Apache-2.0
// Whether two placed halves are as far apart as the outer contour of the cortex beyond their faces says.
//
// Both halves were one bone: its surface goes on across the gap. Halves that are too far apart or too near to each
// other along the normal of an oblique break have a step there, of n·ν times the error at a contour with the normal ν.
// Strips of cortex across the gap, from both halves, give the step; what they do not share is their spread, and so is
// what strips of two lengths say differently, because curved cortex is no parabola. A square
// break through a prism leaves no step however wide it gapes: the estimate then has a spread that says so.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/fit/fit_surface.hpp"

#include <optional>
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

/// `pose`: of the moving half in the frame of the fixed one, as fitted with a kerf of `told` (m; none: 0). The faces hold
/// the halves as well as their covariance says (FitPrecisionSum), so that an error across the opening is part of
/// `spread`. For preparations, not for a tick: it allocates.
ContourOpening contour_opening(const KerfSide& moving, const KerfSide& fixed, const Pose& pose,
                               std::optional<double> told);

/// The kerf that the contour says, beside the one that was told.
struct KerfEstimate {
    std::optional<double> told;  ///< m, mean width, as FitSettings::kerf has it
    double kerf = 0.0, spread = 0.0;  ///< m, mean width
    ContourOpening contour;  ///< what says so; no strips: none was looked at, or none is there
    /// With the kerf that the contour says, the halves would lie more than half a millimetre elsewhere. A contour whose
    /// opening is not known to a millimetre must say more than two standard deviations; one beside no told kerf, more than
    /// half of one.
    bool is_contradicted = false;
    /// No kerf was told, and the contour does not exclude that half a millimetre is lost: what it says and half its standard
    /// deviation are together more. Never where there is no contour.
    bool is_open = false;
    /// Rough faces are between `told` and told / (mean cosine of their slopes) apart along the opening: that leaves
    /// more than half a millimetre.
    bool is_too_wide = false;

    bool is_doubtful() const noexcept { return is_contradicted || is_open || is_too_wide; }
};

/// Of two halves that were fitted with this kerf (m); without one, when nobody told any. Who told that nothing is lost
/// (0) is believed: no contour is looked at.
KerfEstimate check_kerf(const KerfSide& moving, const KerfSide& fixed, const Pose& pose, std::optional<double> told);

/// What the contours of several pairs say together of what is lost between each. The pairs of one case broke in one way:
/// their openings scatter about one mean (random effects: DerSimonian & Laird, Control. Clin. Trials 7, 1986), which is
/// what a pair that says little by itself may have.
struct CommonOpening {
    double missing = 0.0, spread = 1.0;  ///< m, along the openings: the mean and its standard deviation
    double scatter = 0.0;  ///< m, of the pairs beside what their own spreads explain
    int pairs = 0;

    /// Whether this pair is one of them and, as far as it and all together know (posterior mean and one standard
    /// deviation), less than half a millimetre is lost. Never with less than three pairs, and never for a pair that says of
    /// itself that more is lost than all of them, by over two standard deviations.
    bool excludes_kerf(const ContourOpening& pair) const noexcept;
};
/// Of pairs that were fitted without a kerf; those without a contour say nothing.
CommonOpening common_opening(std::span<const ContourOpening> pairs) noexcept;

}  // namespace tactus::fit
