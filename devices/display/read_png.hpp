// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/offscreen.hpp"

#include <string>

namespace tactus::display {

/// A PNG file of at most 4096 pixels a side. Throws Error when it is none, or cannot be read.
Image read_png(const std::string& path);

}  // namespace tactus::display
