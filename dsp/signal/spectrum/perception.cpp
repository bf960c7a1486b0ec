// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/perception.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

double touch_threshold_db(double hz) noexcept { return std::min(0.0, touch_curve_db(hz)); }

double touch_curve_db(double hz) noexcept {
    constexpr double slope = 1.0 / 550.0, offset = 1.0 - 250.0 * slope, height = 62.0, floor = 77.0;
    const double x = std::log10(slope * std::max(hz, 0.0) + offset) / std::log10(offset);
    return height * x * x - floor;
}

double touch_weight_db(double hz, ThresholdUnit unit) noexcept {
    if (unit == ThresholdUnit::none) return 0.0;
    const double below = touch_threshold_db(250.0) - touch_threshold_db(hz);
    return unit == ThresholdUnit::acceleration ? below : below - 40.0 * std::log10(std::max(hz, 1e-3) / 250.0);
}

}  // namespace tactus::signal
