// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/offscreen.hpp"

#include <string>

namespace tactus::display {

/// Reads a PNG file of at most 4096 pixels per side. Throws Error if it is not one or cannot be read.
Image read_png(const std::string& path);

}  // namespace tactus::display
