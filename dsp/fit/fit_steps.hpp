// SPDX-License-Identifier: Apache-2.0
// The steps that a search for a fit is made of: starts, a scale that narrows, and how far apart two poses are.
#pragma once

#include "dsp/coupling/quasi_static.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/fit_energy.hpp"

#include <cstddef>

namespace tactus::fit {

/// The scale of the robust kernel goes from `widest` to `finest` (m) in so many steps, and the power of the collinearity
/// from 1 to `power`.
struct Narrowing {
    double widest, finest;
    int stages;
    double power;
};

/// Springs that pull at nothing: the solver lowers the fit's energy alone. `gyration` of the moving paint, m.
coupling::QuasiStaticSettings free_solver(double gyration) noexcept;

/// Every point takes part, or every so many-th so that about `points` of each side do (0: all).
void set_law(FitEnergy& energy, double outline, std::size_t points = 0) noexcept;

/// Steps of the solver while the scale narrows, weights looked at anew before each. Poses are those of the centres.
Pose anneal(FitEnergy& energy, const Pose& start, const Narrowing& narrowing, int& iterations) noexcept;

/// At the finest scale until the steps are done; then narrower still, to what the scans can tell.
Pose refine(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept;

/// How far the narrowing goes from `finest` on in step `step` of `polish_steps`: what stays of a bias that gaps of lost
/// bone leave at a wide scale goes with the square of it.
inline constexpr int polish_steps = 12;
void set_polish(FitEnergy& energy, const FitSettings& settings, int step) noexcept;

/// The shortest turn that takes direction `from` to `to`.
Quat shortest_turn(const Vec3& from, const Vec3& to) noexcept;

/// Of a mean normal; up when it is nought.
Vec3 direction_of(const Vec3& normal) noexcept;

/// The moving paint's orientation with the mean normals opposed, by the shortest turn from `from`.
Quat opposed(const FitSurface& moving, const FitSurface& fixed, const Quat& from) noexcept;

/// m, of two poses of the same body: way of the middle, and turn at the gyration.
double pose_distance(const Pose& a, const Pose& b, double gyration) noexcept;

}  // namespace tactus::fit
