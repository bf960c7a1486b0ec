// SPDX-License-Identifier: Apache-2.0
// The blade of a bone saw: its size, teeth and stiffness.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus::saw {

/// 18 teeth per inch (Lannin 2011), m.
inline constexpr double tooth_pitch = 25.4e-3 / 18.0;

enum class SawKind : std::uint8_t {
    reciprocating,  ///< the blade strokes along its length, which is along the teeth; clamped at its −x end
    sagittal,  ///< the end of the blade swings about an axis `height` behind the middle of its teeth, where it is
               ///< clamped; the teeth stand on an arc about that axis
};

/// Blade frame: origin in the middle of the tooth line, x along the teeth, y the cutting direction, towards the bone, z
/// across the blade.
struct SawShape {
    SawKind kind = SawKind::reciprocating;
    double length = 0.040;  ///< m, of the tooth line
    double height = 0.010;  ///< m, from the teeth back along −y
    double thickness = 0.0007;  ///< m, along z
    double kerf = 0.001;  ///< m, width of the cut: the teeth are set
    double pitch = tooth_pitch;  ///< m
    double stroke = 0.003;  ///< m peak to peak, along x

    /// How far the teeth at `x` m stand behind those in the middle, m. The arc of a sagittal blade must hold them.
    double behind(double x) const noexcept {
        return kind == SawKind::sagittal ? height - std::sqrt(std::max(height * height - x * x, 0.0)) : 0.0;
    }
};

/// Stiffness of a steel blade against a force across it, as a cantilever: 3·E·I/L³ at the distance L of `local` from
/// the clamp, N/m.
inline double lateral_stiffness(const SawShape& shape, const Vec3& local) noexcept {
    constexpr double steel = 200e9;  // Pa
    constexpr double shortest = 0.005;  // m
    const bool along = shape.kind == SawKind::reciprocating;
    const double width = along ? shape.height : shape.length;
    const double arm = std::max(along ? local.x + 0.5 * shape.length : local.y + shape.height, shortest);
    const double inertia = width * shape.thickness * shape.thickness * shape.thickness / 12.0;
    return 3.0 * steel * inertia / (arm * arm * arm);
}

}  // namespace tactus::saw
