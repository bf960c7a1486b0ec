// SPDX-License-Identifier: Apache-2.0
// What was understood of a record, as fields of results.
#pragma once

#include "assets/sound/record_reader.hpp"
#include "assets/sound/stretch.hpp"
#include "tools/report/result/fields.hpp"

namespace tactus::report {

/// A log with the rate at which it was read.
struct ReadLog {
    const sound::LogFacts* facts;
    double rate;  ///< Hz
};

const Fields<sound::Calibration>& calibration_fields();
const Fields<ReadLog>& log_fields();
/// from_s, to_s, of_s
const Fields<sound::ReadStretch>& stretch_fields();

}  // namespace tactus::report
