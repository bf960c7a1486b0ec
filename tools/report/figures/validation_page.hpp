// SPDX-License-Identifier: Apache-2.0
// The runs of a patch compared with its recordings, as an HTML page.
#pragma once

#include "tools/analysis/vibration/validation.hpp"

#include <string>

namespace tactus::report {

/// A complete page of finished runs.
std::string validation_page(const analysis::Validation& validation);

}  // namespace tactus::report
