// SPDX-License-Identifier: Apache-2.0
// Explains why the bone lost between two fragments is uncertain, and states the next step.
#pragma once

#include "dsp/fit/kerf_check.hpp"

#include <string>

namespace tactus::analysis {

/// Returns the message for a doubtful estimate (KerfEstimate::is_doubtful).
std::string kerf_doubt(const fit::KerfEstimate& kerf);

}  // namespace tactus::analysis
