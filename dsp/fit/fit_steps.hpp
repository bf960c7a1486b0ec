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

/// The robust law with every point, or every n-th so that about `points` of each side take part (0: all). Keeps the
/// kerf.
void set_law(FitEnergy& energy, double outline, std::size_t points = 0) noexcept;

/// Solver steps while the scale narrows, with weights updated before each. Poses are those of the centres.
Pose anneal(FitEnergy& energy, const Pose& start, const Narrowing& narrowing, int& iterations) noexcept;

/// The robust kernel at `finest` times `wider`.
void set_robust(FitEnergy& energy, const FitSettings& settings, double wider) noexcept;

/// At the finest scale until the steps are done; then narrower, down to the resolution of the scans; then without chips.
Pose refine(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept;

/// The scale of step `step` of `polish_steps`: the bias that gaps of lost bone cause at a wide scale falls with its
/// square. The last steps, from `first_intact_step`, are those of what is not chipped, or, where next to nothing is, of all
/// points. Their scale is not narrower than the noise of the scans, see measure_noise: it would take noise for chips.
inline constexpr int polish_steps = 36, first_intact_step = 13;
void set_polish(FitEnergy& energy, const FitSettings& settings, int step) noexcept;

/// Measures, at a pose that is polished, the noise of the scans and how much is chipped, for the last steps. Where
/// next to nothing is, the choice of what to leave out would follow the noise.
void measure_noise(FitEnergy& energy, const FitSettings& settings, const Pose& pose) noexcept;

/// Whether the steps of what is not chipped went farther than they can correct. The steps before leave a bias below
/// their scale; what goes farther has no hold in the points that are left. Such steps are taken back.
bool is_astray(const FitEnergy& energy, const FitSettings& settings, const Pose& before, const Pose& after) noexcept;

/// The shortest rotation from direction `from` to `to`.
Quat shortest_turn(const Vec3& from, const Vec3& to) noexcept;

/// Unit vector of a mean normal; up when it is zero.
Vec3 direction_of(const Vec3& normal) noexcept;

/// The moving paint's orientation with the mean normals opposed, by the shortest rotation from `from`.
Quat opposed(const FitSurface& moving, const FitSurface& fixed, const Quat& from) noexcept;

/// m, distance of two poses of the same body: translation of the middle, plus rotation times the gyration.
double pose_distance(const Pose& a, const Pose& b, double gyration) noexcept;

}  // namespace tactus::fit
