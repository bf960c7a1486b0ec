// SPDX-License-Identifier: Apache-2.0
// Validations as text and CSV, one row per run.
#pragma once

#include "tools/analysis/vibration/validation.hpp"

#include <string>

namespace tactus::command {

/// A text table.
std::string validation_rows(const analysis::Validation& validation);
std::string validation_csv(const analysis::Validation& validation);

}  // namespace tactus::command
