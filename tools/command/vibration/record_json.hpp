// SPDX-License-Identifier: Apache-2.0
// What was understood of a record, as JSON.
#pragma once

#include "assets/sound/record_reader.hpp"

#include <nlohmann/json.hpp>

namespace tactus::command {

nlohmann::ordered_json calibration_json(const sound::Calibration& calibration);
nlohmann::ordered_json log_json(const sound::LogFacts& log, double rate);

}  // namespace tactus::command
