// SPDX-License-Identifier: Apache-2.0
// Building blocks of a search for a fit: starts, a narrowing scale, and the distance of two poses.
#pragma once

#include "dsp/coupling/quasi_static.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/fit_energy.hpp"

#include <cstddef>

namespace tactus::fit {

/// The scale of the robust kernel narrows from `widest` to `finest` (m) in this many steps, and the exponent of the
/// collinearity rises from 1 to `power`.
struct Narrowing {
    double widest, finest;
    int stages;
    double power;
};

/// Springs without force: the solver minimises the fit's energy alone. `gyration` of the moving paint, m.
coupling::QuasiStaticSettings free_solver(double gyration) noexcept;

/// Sets the robust law with every point, or every n-th so that about `points` of each side take part (0: all). Keeps
/// the kerf.
void set_law(FitEnergy& energy, double outline, std::size_t points = 0) noexcept;

/// Solver steps while the scale narrows; updates the weights before each. Poses are those of the centroids.
Pose anneal(FitEnergy& energy, const Pose& start, const Narrowing& narrowing, int& iterations) noexcept;

/// The robust kernel at `finest` times `wider`.
void set_robust(FitEnergy& energy, const FitSettings& settings, double wider) noexcept;

/// Steps at the finest scale, then at narrower scales down to the resolution of the scans, then without chipped points.
Pose refine(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept;

/// Scale of step `step` of `polish_steps`: at a wide scale, gaps of lost bone cause a bias that falls with the square
/// of the scale. The final steps, from `first_intact_step` on, use only points that are not chipped or, if nearly none
/// are chipped, all points. Their scale is at least the noise of the scans (measure_noise), which would otherwise count
/// as chips.
inline constexpr int polish_steps = 36, first_intact_step = 13;
void set_polish(FitEnergy& energy, const FitSettings& settings, int step) noexcept;

/// Measures, at a polished pose, the noise of the scans and the chipped fraction, for the final steps. If nearly
/// nothing is chipped, no points are excluded, because the selection would follow the noise.
void measure_noise(FitEnergy& energy, const FitSettings& settings, const Pose& pose) noexcept;

/// Returns whether the final steps moved farther than they can correct. The preceding steps leave a bias below their
/// scale; a larger motion is not determined by the remaining points, and is rejected.
bool is_astray(const FitEnergy& energy, const FitSettings& settings, const Pose& before, const Pose& after) noexcept;

/// The shortest rotation from direction `from` to `to`.
Quat shortest_turn(const Vec3& from, const Vec3& to) noexcept;

/// Unit vector of a mean normal; up when it is zero.
Vec3 direction_of(const Vec3& normal) noexcept;

/// Returns the orientation of the moving paint with opposed mean normals, by the shortest rotation from `from`.
Quat opposed(const FitSurface& moving, const FitSurface& fixed, const Quat& from) noexcept;

/// Returns the distance in m of two poses of the same body: translation of the centroid, plus rotation times the
/// gyration.
double pose_distance(const Pose& a, const Pose& b, double gyration) noexcept;

}  // namespace tactus::fit
