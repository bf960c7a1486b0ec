// SPDX-License-Identifier: Apache-2.0
// Positions of the window's controls by name, so that scripts can press them with the mouse.
#pragma once

#include "tools/window/widgets/canvas.hpp"

#include <optional>
#include <string>

namespace tactus::window {

/// Registers the control drawn last. Only on the window's thread.
void mark_spot(const std::string& name);
/// Registers a place that is no item, in pixels.
void set_spot(const std::string& name, const Box& box);
/// Position in the last frame; none: not drawn.
std::optional<Box> spot(const std::string& name);
/// Called before each frame.
void forget_spots();

}  // namespace tactus::window
