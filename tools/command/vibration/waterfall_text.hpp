// SPDX-License-Identifier: Apache-2.0
// Waterfalls as CSV and JSON.
#pragma once

#include "assets/file/json.hpp"
#include "tools/analysis/vibration/orders.hpp"

#include <string>

namespace tactus::command {

/// A row per row and channel: channel, time_s (empty against speed), rate_hz, then the rms at each order or frequency,
/// which the heading names; empty above half the sample rate.
std::string waterfall_csv(const analysis::Orders& orders);

/// The same of one channel: {"over", "against", "columns", "rows": [{"time_s", "rate_hz", "rms"}]}.
file::Json waterfall_json(const analysis::Waterfall& waterfall);

}  // namespace tactus::command
