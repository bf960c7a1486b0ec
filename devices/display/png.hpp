// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/offscreen.hpp"

#include <string>

namespace tactus::display {

/// Writes `path` + ".part" and renames it when whole. Throws Error when the file cannot be written.
void write_png(const Image& image, const std::string& path);

/// The bytes of such a file, for pages that carry their pictures.
std::string png_bytes(const Image& image);

}  // namespace tactus::display
