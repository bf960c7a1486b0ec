// SPDX-License-Identifier: Apache-2.0
// Files dragged from another program onto a window: the source's side of the drag-and-drop protocol of X11 (XDND 5,
// freedesktop.org), as a file manager speaks it.
#pragma once

#include "tests/tools/window/display.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::test {

/// Drops the files at a place of the screen, onto the window of that title below it. Empty when the window took them;
/// else what it did not do.
std::string drop_files(const VirtualDisplay& display, const std::string& title,
                       const std::vector<std::filesystem::path>& files, int x, int y);

}  // namespace tactus::test
