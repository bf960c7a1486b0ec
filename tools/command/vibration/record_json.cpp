// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/record_json.hpp"

#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/record_fields.hpp"

namespace tactus::command {

file::Json calibration_json(const sound::Calibration& calibration) {
    return report::json_of(report::calibration_fields().of(calibration));
}

file::Json log_json(const sound::LogFacts& log, double rate) {
    return report::json_of(report::log_fields().of({&log, rate}));
}

}  // namespace tactus::command
