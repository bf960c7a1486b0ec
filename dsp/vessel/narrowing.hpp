// SPDX-License-Identifier: Apache-2.0
// A short narrowing of a vessel, fitted to the scan with its blur: across the vessel and along it.
#pragma once

#include "dsp/vessel/search.hpp"

namespace tactus::vessel {

/// Where a narrowing may be, and how wide it looks.
struct NarrowingGuess {
    double at = 0.0;         ///< m along the branch
    double reference = 0.0;  ///< m: radius of the vessel before and after it
    double depth = 0.0;      ///< 0 to 1, of the radius
    double width = 0.0;      ///< m: length in which it has more than half its depth
};

/// The radius along a branch: r(s) = reference(s) (1 - depth exp(-ln 2 |2 (s - at) / width|^steepness)), where the reference
/// changes evenly over the window.
struct Narrowing {
    double at = 0.0, width = 0.0;  ///< m
    double reference = 0.0;  ///< m, at the narrowing
    double slope = 0.0;  ///< of the reference, per m along, as a share of it
    double depth = 0.0;  ///< 0 to 1
    double depth_error = 0.0;  ///< standard deviation
    double steepness = 2.0;
    double gain = 0.0;  ///< how much better than without a narrowing: difference of chi squared
    double misfit = 0.0;  ///< residual beside noise: variance of the one divided by that of the other

    double radius(double along) const;
};

/// Fits brightness k · (tube of this radius, blurred in three dimensions) + background, by Levenberg and Marquardt. A tube of
/// changing radius about a straight axis under a normal blur is the blurred disc of each place, blurred along the axis; the
/// branch is straightened for it. The lumen may move aside within the narrowing, and the blur may differ from the stated one
/// by some 15 %. What is expected where the scan does not tell: a width of 0.7 to 3 radii, a steepness of 1.7 to 3.7 (1 is a
/// peak, 2 round, 4 nearly flat). The error is that of the fit, with these expectations. None where the branch is shorter
/// than the narrowing and two radii. Allocates.
std::optional<Narrowing> fitted_narrowing(const Search& search, const Noise& noise, const Branch& branch,
                                          const NarrowingGuess& guess);

}  // namespace tactus::vessel
