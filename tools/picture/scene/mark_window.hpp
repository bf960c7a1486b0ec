// SPDX-License-Identifier: Apache-2.0
// A full screen that shows a mark to be touched.
#pragma once

#include "dsp/display/rig_touches.hpp"

#include <memory>
#include <string>

namespace tactus::picture {

/// A cross at the mark of a screen on black, into what is bound; for other touches nothing but black. Needs a current
/// context.
void draw_mark(const display::RigTouch& touch, int width, int height);

class MarkWindow {
public:
    /// On a monitor, from 1. Throws Error when there is no display, no such monitor or no OpenGL.
    explicit MarkWindow(int monitor);
    ~MarkWindow();
    MarkWindow(const MarkWindow&) = delete;
    MarkWindow& operator=(const MarkWindow&) = delete;

    /// A cross at the mark of a screen; for other touches the words alone.
    void show(const display::RigTouch& touch, const std::string& words);
    /// Some times a second. False: it was closed, or Escape was pressed.
    bool draw();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tactus::picture
