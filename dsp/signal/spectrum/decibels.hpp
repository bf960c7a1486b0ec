// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace tactus::signal {

/// Returns the decibels of a ratio of powers; −300 dB for 0.
inline double decibels(double power_ratio) { return 10.0 * std::log10(std::max(power_ratio, 1e-30)); }

}  // namespace tactus::signal
