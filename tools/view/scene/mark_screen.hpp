// SPDX-License-Identifier: Apache-2.0
// A window beside the viewer's own that shows the mark to be touched.
#pragma once

#include "dsp/display/rig_touches.hpp"
#include "tools/view/scene/screen_window.hpp"
#include "tools/view/scene/texture_target.hpp"

namespace tactus::view {

class MarkScreen {
public:
    /// On a monitor, from 1, all of it; 0: a window somewhere. Throws Error.
    explicit MarkScreen(int monitor) : window_("mark", {monitor, {}, false}) {}

    void show(const display::RigTouch& touch);
    bool wants_to_close() const { return window_.wants_to_close(); }

private:
    ScreenWindow window_;
    TextureTarget target_;
};

}  // namespace tactus::view
