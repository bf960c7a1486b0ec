// SPDX-License-Identifier: Apache-2.0
// Detects that a motion in contact went through the middle of a wall.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <algorithm>
#include <cstddef>

namespace tactus::coupling {

/// True when contact resisted the motion at its start and drives it on at its end, with a force turned by more than 90°
/// and points deeper than `depth` m at both ends. That happens in the middle of a wall, where the nearest surface
/// changes sides; sliding over a bump turns the force less, and going from one wall of a gap to the other leaves the
/// first wall in the direction of its force. Sums over all points: a larger contact elsewhere can hide it.
inline bool crosses_wall(const contact::ContactSum& before, const contact::ContactSum& after,
                         const geometry::Vector6& displacement, double depth) noexcept {
    if (std::min(before.penetration, after.penetration) <= depth) return false;
    double resists = 0.0, drives = 0.0, turned = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
        resists += before.gradient[i] * displacement[i];
        drives -= after.gradient[i] * displacement[i];
        if (i < 3) turned -= before.gradient[i] * after.gradient[i];
    }
    return resists > 0.0 && drives > 0.0 && turned > 0.0;
}

}  // namespace tactus::coupling
