// SPDX-License-Identifier: Apache-2.0
// The largest force that may be given, and how a force fades to zero: one law each, for the output of a patch, the guard of a
// device and the process of a device.
#pragma once

#include "dsp/core/types.hpp"

#include <limits>

namespace tactus::control {

/// `v`, at most `length` long. Scaled by its largest component first: the square of 1e200 N would overflow.
Vec3 shorten(const Vec3& v, double length) noexcept;

/// The largest wrench that may be given. Infinite: there is no bound. Zero: none may be given at all.
struct ForceBounds {
    double force = std::numeric_limits<double>::infinity(),
           torque = std::numeric_limits<double>::infinity();  ///< N, N·m

    /// `wanted`, its direction kept, within the bounds; no wrench at all if it is not finite.
    Wrench clamp(const Wrench& wanted) const noexcept;
};

/// Bounds of a device that states these. 0: it states none.
constexpr ForceBounds stated_bounds(double max_force, double max_torque) noexcept {
    constexpr double none = std::numeric_limits<double>::infinity();
    return {max_force > 0.0 ? max_force : none, max_torque > 0.0 ? max_torque : none};
}

/// What is left of a force `age` after its fade began, 1 to 0, of a fade that takes `length` in the same unit. Linear: a
/// hand that the force holds is not thrown into the motion that a jump would cause, and the end is known.
inline double fade_left(double age, double length) noexcept {
    // The margin allows for rounding: ten ticks of 1 ms can sum to just under 10 ms.
    return age < length * (1.0 - 1e-9) ? (age > 0.0 ? 1.0 - age / length : 1.0) : 0.0;
}

}  // namespace tactus::control
