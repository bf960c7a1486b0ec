// SPDX-License-Identifier: Apache-2.0
// The hand that every bound on a haptic loop assumes.
#pragma once

namespace tactus::control {

/// The lightest hand on a device, and the damping that its grip adds. Makers of devices specify no damping, and the
/// mechanism alone damps next to nothing (a Touch 0.1 N·s/m), so that a bound without a hand would permit 0.07 N/mm. Light
/// grips measure 2 to 10 N·s/m (Hajian and Howe 1997; Kuchenbecker, Park and Niemeyer 2003): the least of these counts.
struct StatedHand {
    static constexpr double mass = 0.1;  ///< kg, with the handle
    static constexpr double inertia = 1e-4;  ///< kg·m²
    static constexpr double damping = 2.0;  ///< N·s/m
};

}  // namespace tactus::control
