// SPDX-License-Identifier: Apache-2.0
// The lines of a painting script, checked before the first one runs.
#pragma once

#include "tools/window/files/script_line.hpp"

#include <string>
#include <vector>

namespace tactus::window {

/// The commands of PaintScript. Throws Error for an unknown command, for words that are missing or too many, and where a
/// number or the name of a view is expected and there is none.
std::vector<ScriptLine> paint_lines(const std::string& text, const std::string& file);

}  // namespace tactus::window
