// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/mark_screen.hpp"

#include "tools/render/mark_window.hpp"

#include <algorithm>

namespace tactus::window {

using render::draw_mark;

void MarkScreen::show(const display::Touch& touch) {
    // The size of the window is known after the first frame.
    const int width = std::max(window_.width(), 64), height = std::max(window_.height(), 64);
    target_.begin(width, height, 1);
    draw_mark(touch, width, height);
    target_.end();
    window_.show(target_.texture(), 0, width, height, false);
}

}  // namespace tactus::window
