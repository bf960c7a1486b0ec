// SPDX-License-Identifier: Apache-2.0
// The runs of a patch compared with its recordings, as an HTML page.
#pragma once

#include "tools/study/vibration/validation.hpp"

#include <string>

namespace tactus::picture {

/// A complete page of finished runs.
std::string validation_page(const study::Validation& validation);

}  // namespace tactus::picture
