// SPDX-License-Identifier: Apache-2.0
// A second window that shows the mark to touch.
#pragma once

#include "dsp/display/display_fit.hpp"
#include "tools/window/scene/screen_window.hpp"
#include "tools/window/scene/texture_target.hpp"

namespace tactus::window {

class MarkScreen {
public:
    /// Full screen on a monitor, from 1; 0: an ordinary window. Throws Error.
    explicit MarkScreen(int monitor) : window_("mark", {monitor, {}, false}) {}

    void show(const display::Touch& touch);
    bool wants_to_close() const { return window_.wants_to_close(); }

private:
    ScreenWindow window_;
    TextureTarget target_;
};

}  // namespace tactus::window
