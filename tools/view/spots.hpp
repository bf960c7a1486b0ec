// SPDX-License-Identifier: Apache-2.0
// Where the controls of the window stand, by name: so that a script can press them as a hand would.
#pragma once

#include "tools/view/canvas.hpp"

#include <optional>
#include <string>

namespace tactus::view {

/// The control that was drawn last. Of the thread of the window.
void mark_spot(const std::string& name);
/// As of the last picture; none: it was not drawn.
std::optional<Box> spot(const std::string& name);
/// Before each picture.
void forget_spots();

}  // namespace tactus::view
