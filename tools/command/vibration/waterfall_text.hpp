// SPDX-License-Identifier: Apache-2.0
// Waterfalls as CSV.
#pragma once

#include "tools/analysis/vibration/orders.hpp"

#include <string>

namespace tactus::command {

/// A row per row and channel: channel, time_s (empty against speed), rate_hz, then the rms at each order or frequency,
/// which the heading names; empty above half the sample rate.
std::string waterfall_csv(const analysis::Orders& orders);

}  // namespace tactus::command
