// SPDX-License-Identifier: Apache-2.0
// Checks the distance of two placed halves against the outer contour of the cortex beyond their faces.
//
// Both halves were one bone, whose surface continues across the gap. If the halves of an oblique break are too far
// apart or too close along its normal n, the contour has a step there: n·ν times the error, at a contour with the
// normal ν. Strips of cortex across the gap, on both halves, give the step. Its spread is estimated from the
// disagreement of the strips, and of strips of two lengths, because curved cortex is not a parabola. A square break
// through a prism leaves no step at any width of the gap; the estimate then has a large spread. Flat faces slide along
// each other until the contour has no step, so it excludes no loss between them.
//
// Rough faces that interlock are the evidence that no bone is lost. Only relief that both faces share counts: the grain
// that teeth leave differs between the faces. A freehand saw cut is wavy, and its waves close over the lost bone like a
// whole break; but the edge of a blade is straight, so that the cut is a ruled surface, straight along one direction,
// however tight its waves. Relief is therefore measured twice: about planes through the points within 3 mm, and about
// ruled surfaces, in the directions in which the faces share least and most. The rms height of a face contains the waves
// and the grain.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/fit_surface.hpp"

#include <optional>
#include <span>

namespace tactus::fit {

/// One half: its whole surface, and the face in contact with the other half.
struct KerfSide {
    std::span<const contact::SurfacePoint> points;
    const FitSurface* face = nullptr;
};

struct ContourOpening {
    double excess = 0.0;  ///< m along the opening: excess of the halves' distance over that of the contour
    double spread = 1.0;  ///< m, standard deviation of `excess`; large if the contour is uninformative
    int strips = 0;  ///< number of strips found on both halves
};

/// `pose`: of the moving half in the frame of the fixed one, as fitted with a kerf of `given` (m; none: 0). The error of
/// the fit itself (FitPrecisionSum) across the opening is part of `spread`. For preparation, not for a tick: it
/// allocates.
ContourOpening contour_opening(const KerfSide& moving, const KerfSide& fixed, const Pose& pose,
                               std::optional<double> given);

/// The kerf estimated from the contour, and the given one.
struct KerfEstimate {
    std::optional<double> given;  ///< m, mean width, as in FitSettings::kerf; the given kerf
    double kerf = 0.0, spread = 0.0;  ///< m, mean width
    ContourOpening contour;  ///< source of the estimate; no strips: the contour was not used, or none was found
    /// True if the contour contradicts the kerf: it would shift the halves by more than half a millimetre. A contour
    /// with a standard deviation of 1 mm or more must give a shift of two standard deviations instead. Without a given
    /// kerf, the shift must also exceed half a standard deviation.
    bool is_contradicted = false;
    /// True if no kerf was given and the faces share less than 0.1 mm of local relief (rms), or along one direction less than
    /// 0.3 of that along another, as after a saw cut. Otherwise nothing is lost, or a layer of even thickness that no
    /// straight blade removed.
    bool is_flat = false;
    /// m along the opening: largest loss that is not excluded, if no kerf was given. Beside a contour whose estimate plus
    /// half a standard deviation exceeds half a millimetre: the estimate plus two standard deviations. Between flat faces:
    /// at least 3 mm. Otherwise 0.
    double loss = 0.0;
    /// True if a loss is not excluded, and not contradicted either.
    bool is_open = false;
    /// True if the given kerf is ambiguous by more than half a millimetre: the opening of rough faces lies between
    /// `given` and given / (mean cosine of their slopes).
    bool is_too_wide = false;

    bool is_doubtful() const noexcept { return is_contradicted || is_open || is_too_wide; }
};

/// Checks two halves that were fitted with this kerf (m); without a value, no kerf was given. A given kerf of 0
/// (nothing lost) is accepted without checking the contour.
KerfEstimate check_kerf(const KerfSide& moving, const KerfSide& fixed, const Pose& pose, std::optional<double> given);

/// Adds the loss to the bound of a fit or an uncertain fit, and returns its verdict: `ambiguous` for a fit whose kerf is
/// contradicted or too wide, `uncertain` for one whose kerf is open. An uncertain fit becomes `ambiguous` only because of
/// a given kerf; without one, its bound includes the loss. Other verdicts have no place whose kerf matters: neither they
/// nor their bounds change.
FitVerdict include_kerf(const KerfEstimate& kerf, FitVerdict verdict, PoseBound& bound) noexcept;

/// Common estimate of the bone lost between each of several pairs, from all their contours. The pairs of one case broke
/// in the same way, so their openings scatter around one mean (random effects: DerSimonian & Laird, Control. Clin.
/// Trials 7, 1986). This mean serves a pair whose own contour is uninformative.
struct CommonOpening {
    double missing = 0.0, spread = 1.0;  ///< m, along the openings: the mean and its standard deviation
    double scatter = 0.0;  ///< m, scatter of the pairs beyond their own spreads
    int pairs = 0;

    /// Returns whether this pair belongs to the common distribution and lost less than half a millimetre, by its
    /// posterior mean plus one standard deviation. False with fewer than three pairs, and false for a pair whose own
    /// estimate exceeds the mean by over two standard deviations.
    bool excludes_kerf(const ContourOpening& pair) const noexcept;
};
/// For pairs fitted without a kerf; pairs without a contour are ignored.
CommonOpening common_opening(std::span<const ContourOpening> pairs) noexcept;

}  // namespace tactus::fit
