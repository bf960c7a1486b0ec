// SPDX-License-Identifier: Apache-2.0
// What was understood of a record, as JSON.
#pragma once

#include "assets/file/json.hpp"
#include "assets/sound/record_reader.hpp"

namespace tactus::command {

file::Json calibration_json(const sound::Calibration& calibration);
file::Json log_json(const sound::LogFacts& log, double rate);

}  // namespace tactus::command
