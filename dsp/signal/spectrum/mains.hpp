// SPDX-License-Identifier: Apache-2.0
// Orders of the mains among the lines of a vibration: hum, or a machine at such a rate.
#pragma once

#include <cmath>

namespace tactus::signal {

/// Relative deviation of the mains from 50 or 60 Hz that is accepted everywhere. Grid operators keep it within 0.4 % in
/// normal operation (49.8 to 50.2 Hz); one record shows one value, which its lines have in common.
inline constexpr double mains_range = 5e-3;
/// Nominal frequencies of the mains, Hz.
inline constexpr int mains_frequencies[] = {50, 60};
/// Hum of higher orders is too weak to matter.
inline constexpr int max_mains_order = 12;
/// Hum has one of its first orders: the mains itself, or those of transformers and rectifiers.
inline constexpr int max_founding_order = 3;

/// Order of mains of `nominal` Hz (1 … max_mains_order) that a line at `hz`, known to `uncertainty` Hz, may be; 0:
/// none.
inline int mains_order(double hz, double nominal, double uncertainty = 0.0) {
    const double order = std::round(hz / nominal);
    const bool is_order = order >= 1.0 && order <= max_mains_order &&
                          std::abs(hz - order * nominal) <= mains_range * order * nominal + uncertainty;
    return is_order ? static_cast<int>(order) : 0;
}

/// Whether a line at `hz` may be an order of 50 or 60 Hz.
inline bool is_mains_order(double hz, double uncertainty = 0.0) {
    for (const int nominal : mains_frequencies)
        if (mains_order(hz, nominal, uncertainty) > 0) return true;
    return false;
}

}  // namespace tactus::signal
