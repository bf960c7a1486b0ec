// SPDX-License-Identifier: Apache-2.0
// How much of the heat of cutting enters the bone and how much leaves with the chip.
#pragma once

#include "dsp/saw/cutting_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::saw {

/// Tangent of the shear angle of a tooth with a rake of 0: Merchant's 45° − ½ arctan(thrust/cutting).
inline double tangent_of_shear(const CuttingLaw& law) noexcept {
    return std::tan(0.25 * std::numbers::pi - 0.5 * std::atan(law.thrust_shallow / law.cutting));
}

/// Share of the heat of the shear plane that flows into the work (Weiner 1955, Trans ASME 77: 1331): the faster a tooth
/// shears and the deeper it cuts, the more heat the chip takes. `speed` m/s, `depth` of cut m, `diffusivity` m²/s. 1 where
/// nothing is cut, falling to 1/(4 Y), Y = speed·depth·tan φ/(4·diffusivity).
inline double share_into_bone(double speed, double depth, double tangent, double diffusivity) noexcept {
    const double y = speed * depth * tangent / (4.0 * diffusivity);
    if (!(y > 1e-6)) return 1.0;
    if (y > 25.0) return 1.0 / (4.0 * y);
    const double root = std::sqrt(y);
    const double share = std::erf(root) / (4.0 * y) + (1.0 + y) * std::erfc(root) -
                         std::exp(-y) / std::sqrt(std::numbers::pi) * (0.5 / root + root);
    return std::clamp(share, 0.0, 1.0);
}

}  // namespace tactus::saw
