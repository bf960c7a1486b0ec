// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "devices/display/figure.hpp"
#include "devices/display/offscreen.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tactus::display {

/// Writes a PNG file atomically. Throws Error when it cannot be written.
void write_png(const Image& image, const std::string& path);

/// Returns the bytes of a PNG file with a palette of at most 256 colours; `cells` has columns × rows indices, row by
/// row.
std::string palette_png_bytes(int columns, int rows, std::span<const std::uint8_t> cells,
                              std::span<const Colour> palette);

/// Encodes bytes as Base64, for images inside SVG and HTML.
std::string base64(std::string_view bytes);

/// Returns the bytes of a PNG file. `dpi` 0: it states no resolution.
std::string png_bytes(const Image& image, double dpi = 0.0);

}  // namespace tactus::display
