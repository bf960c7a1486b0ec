// SPDX-License-Identifier: Apache-2.0
// Pictures of one attempt: the cut bone, the face of the cut, and its course in time.
#pragma once

#include "tools/analysis/training/score.hpp"
#include "tools/report/figures/axes.hpp"

#include <cstddef>

namespace tactus::report {

/// The bone with its kerf, the outline of one planned plane of the task in blue, structures to spare in red. Throws Error when
/// nothing can be drawn.
display::Image draw_cut_bone(const analysis::ScoredRun& run, std::size_t cut);

/// The bone opened along one cut: the wall coloured by its distance from where it was planned, uncut bone dark.
/// Throws Error when nothing can be drawn.
display::Image draw_cut_face(const analysis::ScoredRun& run, std::size_t cut);

/// Colour of a distance from the plan: blue and red at twice the tolerance to either side, pale at 0. sRGB, 0 to 1.
Vec3 deviation_colour(double distance, double tolerance);

/// Depth, distance from the plan, and force over time, with their limits.
display::Figure draw_attempt(const analysis::ScoredRun& run);

}  // namespace tactus::report
