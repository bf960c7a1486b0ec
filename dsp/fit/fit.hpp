// SPDX-License-Identifier: Apache-2.0
// Snap-to-fit without a hand: finds the pose at which two painted surfaces fit, and the reliability of the fit.
//
// The extended mode minimises the robust two-sided energy by Gauss–Newton steps of the coupling's solver, with a scale
// that narrows from 4 mm to 0.25 mm, from the start and from poses around it, and keeps the pose with the best score.
// The global mode starts from 24 spins about the normals, independent of the start. The thesis' mode follows its rule
// (constant pull of the moving points, contact, a hand on springs that yields in 50 ms).
#pragma once

#include "dsp/fit/acceptance.hpp"
#include "dsp/fit/fit_energy.hpp"
#include "dsp/fit/fit_precision.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::fit {

enum class FitMode : std::uint8_t { thesis, extended, global };

enum class FitVerdict : std::uint8_t {
    fit,  ///< one pose, constrained in all directions
    sliding,  ///< it can move along `free` without losing the fit: flat, round or straight surfaces
    ambiguous,  ///< another pose fits equally well
    no_match,  ///< the surfaces do not belong together
    blocked,  ///< the surfaces fit, but the bones would overlap
    uncertain  ///< the best pose, with an error beyond the limits: the faces are too small or too chipped
};
std::string_view name_of(FitVerdict verdict);

/// The verdict in the terms of a plan: "fit", "fit, uncertain" or "no match".
std::string_view answer_of(FitVerdict verdict);

/// A motion that the fit does not constrain.
struct FreeDirection {
    bool is_rotation = false;
    Vec3 axis{0.0};  ///< unit, fixed frame; a rotation is about the centroid of the moving paint
};

struct FitSettings {
    double widest = 4e-3, finest = 0.25e-3;  ///< m, scale of the robust kernel
    double power = 3.0;  ///< exponent of the collinearity at the finest scale
    double polish = 0.1e-3;  ///< m, scale of the last steps; with lost bone, a wider one is biased into the gap
    double polish_power = 6.0;  ///< exponent of the collinearity in the last steps
    double intact = 0.1e-3;  ///< m, scale of the final steps, which exclude chipped points
    double kerf = 0.0;  ///< m, mean width of bone lost over the whole faces; the fit leaves this gap open
    double max_way = 25e-3, max_turn = 1.05;  ///< m and rad: limits of an extended fit's motion from its start
    double outline = 0.3;  ///< weight of the outer contour
    double sigma = 0.2e-3;  ///< m, of the score
    double pull = 30.0;  ///< N, thesis mode: sum over all painted points
    double min_score = Acceptance::min_score;  ///< below it the result is no_match
    double max_rms = Acceptance::max_rms;  ///< maximum rms distance in the overlap, fraction of sigma
    double min_overlap = Acceptance::min_area;  ///< m²; a smaller overlap is chance: no_match
    double min_share = Acceptance::min_share;  ///< of the smaller paint; a smaller overlap is chance: no_match
    double min_margin = Acceptance::min_margin;  ///< to the second best pose, as fraction of the best score
    double max_far = Acceptance::max_far;  ///< m, at the far end: a less precise pose is uncertain
    double min_hold = 0.008;  ///< mean square slope along a direction that still counts as constrained
    double max_penetration = 0.5e-3;  ///< m

    /// Minimum scores of an uncertain fit and of a fit. Coarse voxels blur the relief: unrelated faces score up to 0.5 at
    /// 1 mm (0.28 at 0.5 mm and below); related ones score at least 0.65, or 0.42 for thin shafts.
    double min_uncertain_score() const noexcept { return min_score + 0.8e3 * blur(); }
    double min_fit_score() const noexcept { return min_score + 1.2e3 * blur(); }

private:
    /// m, of sigma, beyond that of voxels of 0.5 mm.
    double blur() const noexcept { return std::max(0.0, sigma - 0.25e-3); }
};

/// Widens the scales for coarse scans, whose surfaces are no more precise than their voxels.
void widen_for(FitSettings& settings, const Vec3& spacing) noexcept;

/// Returns the defaults, widened for the voxels of both fields.
FitSettings settings_for(const FitSurface& moving, const FitSurface& fixed);

struct Fit {
    Pose pose;  ///< of the moving body in the fixed body's frame
    FitQuality quality;
    double margin = 0.0;  ///< (best − second best score) / best, in [0, 1]; poses within 1 mm count as one
    FitVerdict verdict = FitVerdict::no_match;
    FitPrecision precision;
    PoseBound bound;
    std::vector<FreeDirection> free;
    std::array<double, 6> hold{};  ///< mean square slope along the directions, ascending
    int iterations = 0;  ///< steps of the solver, over all starts
    std::size_t moving_face = 0, fixed_face = 0;  ///< of lists of faces: those that fit
};

/// Returns the first of these verdicts that applies: no_match, sliding (`is_free`), ambiguous (`margin`), blocked,
/// uncertain (`far` of FitPrecision, m, or a face that fails a limit but is likely); otherwise fit.
FitVerdict judge(const FitQuality& quality, bool is_free, double margin, const FitSettings& settings,
                 double far = 0.0) noexcept;

/// `start`: pose of the moving body in the fixed body's frame, both frames those of the files. Deterministic.
Fit find_fit(const FitSurface& moving, const FitSurface& fixed, const Pose& start, FitMode mode,
             const FitSettings& settings = {});

/// Returns the best fit of any moving face to any fixed one; `margin` refers to the next best pose of all pairs.
/// Neither list may be empty. `kerf`: as in FitSettings.
Fit find_fit(std::span<const FitSurface> moving, std::span<const FitSurface> fixed, const Pose& start, FitMode mode,
             double kerf = 0.0);

/// Minimises the energy from `start` at the finest scale only: refines a fit while the hand still holds the body. Poses
/// are those of the bodies. Does not allocate beyond `energy`.
Pose settle(FitEnergy& energy, const Pose& start, const FitSettings& settings, int* iterations = nullptr) noexcept;

/// Converts poses between the bodies' frames and the frames at the centroids of their paint.
Pose between_centres(const FitSurface& moving, const FitSurface& fixed, const Pose& bodies);
Pose between_bodies(const FitSurface& moving, const FitSurface& fixed, const Pose& centres);

}  // namespace tactus::fit
