// SPDX-License-Identifier: Apache-2.0
// Explains a doubt about the bone lost between two fragments, with the next step.
#pragma once

#include "dsp/fit/kerf_check.hpp"

#include <string>

namespace tactus::analysis {

/// For an estimate that is doubtful.
std::string kerf_doubt(const fit::KerfEstimate& kerf);

}  // namespace tactus::analysis
