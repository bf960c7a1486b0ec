// SPDX-License-Identifier: Apache-2.0
// Texts that are longer than their room.
#pragma once

#include <string>

namespace tactus::window {

/// The text, or as much of its beginning as fits into the width with "…" behind it; pixels, in the current font.
std::string elided(const std::string& text, double width);

}  // namespace tactus::window
