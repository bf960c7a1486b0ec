// SPDX-License-Identifier: Apache-2.0
// Settings, input and result of carving.
#pragma once

#include "dsp/core/types.hpp"

#include <array>

namespace tactus::carve {

/// One step of the blade's path. Blade frame: x along the blade (the stroke), y the cutting direction, towards the
/// bone, z normal to the blade; origin in the middle of the tooth edge. The pose is the blade's at the end of `dt`.
struct CarveSample {
    Pose pose;
    double dt = 0.001;  ///< s, duration of the step to this pose
    double thrust = 0.0;  ///< N, along y
    double rate = 0.0;  ///< strokes to and fro per second, Hz
    bool running = false;
};

/// A reciprocating saw. The default advance is that of cortical bone at 228 Hz: 40 mm/min (Yu 2023), with 7 N of thrust
/// (Lannin 2011). It is inversely proportional to density and proportional to rate and thrust^force_exponent.
struct CarveSettings {
    double blade_length = 0.040;  ///< m, from the first tooth to the last
    double kerf = 0.001;  ///< m, width of the cut
    double tooth_pitch = 0.00094;  ///< m
    double stroke = 0.003;  ///< m peak to peak; at least the tooth pitch, otherwise ridges would remain
    double speed = 0.67e-3;  ///< m/s of advance under the reference conditions
    double reference_force = 7.0;  ///< N
    double reference_rate = 228.0;  ///< Hz
    double reference_density = 1800.0;  ///< kg/m³
    double force_exponent = 0.0;  ///< 0: advance does not depend on thrust
    double depth = 0.003;  ///< m below a cut to which the field remains a distance
};

/// Upper limits of the density classes of removed bone, kg/m³: 350, 700, 1200.
inline constexpr std::array<double, 3> density_class_limits{350.0, 700.0, 1200.0};

struct CarveResult {
    double removed_m3 = 0.0;
    std::array<double, 4> removed_by_density{};  ///< m³, see density_class_limits
    int dirty_bricks = 0;  ///< changed but not yet published
    bool budget_hit = false;  ///< a part of the cut is postponed to the next update
};

}  // namespace tactus::carve
