// SPDX-License-Identifier: Apache-2.0
// Verdicts of exposure in words, for every part of the body.
#pragma once

#include "assets/file/json.hpp"
#include "tools/analysis/vibration/exposure.hpp"

#include <string>

namespace tactus::command {

/// Of JSON: "below_action".
const char* verdict_name(analysis::ExposureVerdict verdict);

/// "A(8) 3.2 m/s^2: above the action value, 2.5". `what`: "A(8)"; `unit`: "m/s^2".
std::string verdict_text(const std::string& what, const char* unit, double value, const signal::ExposureLimits& limits,
                         bool is_lower_bound);

/// Minutes of a time in s; null when it is infinite.
file::Json minutes_json(double seconds);
/// "after 23 min", "not within a day"; of a lower bound "after at most 23 min", "cannot be judged".
std::string reached_text(double seconds, bool is_lower_bound);

}  // namespace tactus::command
