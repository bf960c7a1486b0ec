// SPDX-License-Identifier: Apache-2.0
// Fits a short narrowing of a vessel to the scan, including its blur across and along the vessel.
#pragma once

#include "dsp/vessel/search.hpp"

namespace tactus::vessel {

/// Initial values of a narrowing.
struct NarrowingGuess {
    double at = 0.0;         ///< m along the branch
    double reference = 0.0;  ///< m: radius of the vessel before and after it
    double depth = 0.0;      ///< 0 to 1, of the radius
    double width = 0.0;      ///< m: length with more than half of the depth
};

/// The radius along a branch: r(s) = reference(s) (1 - depth exp(-ln 2 |2 (s - at) / width|^steepness)), where the reference
/// changes evenly over the window.
struct Narrowing {
    double at = 0.0, width = 0.0;  ///< m
    double reference = 0.0;  ///< m, at the narrowing
    double slope = 0.0;  ///< of the reference, per m along, as a fraction of it
    double depth = 0.0;  ///< 0 to 1
    double depth_error = 0.0;  ///< standard deviation
    double steepness = 2.0;
    double gain = 0.0;  ///< improvement over a fit without narrowing: difference of chi squared
    double misfit = 0.0;  ///< ratio of the residual variance to the noise variance

    double radius(double along) const;
};

/// Fits brightness k · (tube of this radius, blurred in three dimensions) + background, by Levenberg and Marquardt. The
/// branch is straightened first. For a straight axis and a normal blur, the blurred tube of changing radius is the
/// blurred disc of each position, blurred along the axis. The lumen may shift sideways within the narrowing, and the
/// blur may differ from the given one by some 15 %. Priors apply where the scan is not informative: a width of 0.7 to 3
/// radii, a steepness of 1.7 to 3.7 (1 is a peak, 2 round, 4 nearly flat). The error is that of the fit, including
/// these priors. Empty if the branch is shorter than the narrowing and two radii. Allocates.
std::optional<Narrowing> fitted_narrowing(const Search& search, const Noise& noise, const Branch& branch,
                                          const NarrowingGuess& guess);

}  // namespace tactus::vessel
