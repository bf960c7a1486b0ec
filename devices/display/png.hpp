// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/offscreen.hpp"

#include <string>

namespace tactus::display {

/// Writes a PNG file atomically. Throws Error when it cannot be written.
void write_png(const Image& image, const std::string& path);

/// The bytes of a PNG file, for HTML pages with embedded pictures.
std::string png_bytes(const Image& image);

}  // namespace tactus::display
