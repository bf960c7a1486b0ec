// SPDX-License-Identifier: Apache-2.0
// Published measurements of bone sawing, and the cutting law fitted to some of them.
#pragma once

#include "dsp/saw/cutting_law.hpp"

#include <cmath>

namespace tactus::saw {

/// James, Pearlman, Saigal: Predictive force model for haptic feedback in bone sawing. Med Eng Phys 35 (2013) 1638–1644.
/// One tooth in bovine cortical bone, 1.7 to 7 m/s: no effect of speed; from 2 to 10 µm depth of cut thrust rises by
/// 30 %, nearly in a straight line, and the cutting force stays.
namespace james_2013 {
inline constexpr double shallow = 2e-6, deep = 10e-6, thrust_rise = 1.3;
/// Ratio of thrust to cutting force at both ends.
inline constexpr double ratio_shallow = 1.4, ratio_deep = 1.8;
}  // namespace james_2013

/// Pearlman and others: Rounded cutting edge model for the prediction of bone sawing forces. J Biomech Eng 134 (2012)
/// 071001. Resultant of 8 N at the least depth of cut, 2.5 µm, to 11 N at the greatest, 10 µm, at 2.6 to 6.2 m/s.
namespace pearlman_2012 {
inline constexpr double depth_low = 2.5e-6, depth_high = 10e-6, resultant_low = 8.0, resultant_high = 11.0;
}

/// Lannin, Kelly, James: Reciprocating bone saw: effect of blade speed on cutting rate. ASME 2011. The cutting rate rose
/// a little more than in proportion to the blade's speed. Not fitted.
namespace lannin_2011 {
inline constexpr double thrust = 7.0, stroke = 3e-3, pitch = 25.4e-3 / 18.0;
}

/// Yu and others: Sawing characteristics of dental reciprocating saws. Lubricants 11 (2023) 441. Least force near 13,700
/// strokes a minute at 40 mm/min, in fresh bovine scapula. Not fitted.
namespace yu_2023 {
inline constexpr double rate = 13'700.0 / 60.0, feed = 40e-3 / 60.0;
}

/// Least squares of logarithms: the ratios of James 2013 give thrust over cutting force, the resultants of Pearlman 2012
/// its size.
inline CuttingLaw fit_cutting_law() noexcept {
    namespace j = james_2013;
    namespace p = pearlman_2012;
    const double ratio = std::sqrt(j::ratio_shallow * j::ratio_deep / j::thrust_rise);
    const auto at = [&](double depth) {
        return ratio * (1.0 + (j::thrust_rise - 1.0) * (depth - j::shallow) / (j::deep - j::shallow));
    };
    const double cutting = std::sqrt(p::resultant_low * p::resultant_high /
                                     (std::hypot(1.0, at(p::depth_low)) * std::hypot(1.0, at(p::depth_high))));
    CuttingLaw law;
    law.cutting = cutting;
    law.thrust_shallow = cutting * ratio;
    law.thrust_deep = cutting * ratio * j::thrust_rise;
    law.rub = 0.1 * law.thrust_shallow;
    law.shallow = j::shallow;
    law.deep = j::deep;
    law.deepest = 2.0 * j::deep;
    return law;
}

}  // namespace tactus::saw
