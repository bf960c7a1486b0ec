// SPDX-License-Identifier: Apache-2.0
// The runs of a patch beside the recordings that it plays, as a page.
#pragma once

#include "tools/study/vibration/validation.hpp"

#include <string>

namespace tactus::picture {

/// A complete page of runs that are done.
std::string validation_page(const study::Validation& validation);

}  // namespace tactus::picture
