// SPDX-License-Identifier: Apache-2.0
// A full-screen window that shows a calibration mark.
#pragma once

#include "dsp/display/display_fit.hpp"

#include <memory>
#include <string>

namespace tactus::render {

/// Draws a cross at the mark of a screen on black into the bound framebuffer; only black for other touches. Needs a
/// current context.
void draw_mark(const display::Touch& touch, int width, int height);

class MarkWindow {
public:
    /// `monitor` counts from 1. Throws Error without a display, the monitor or OpenGL.
    explicit MarkWindow(int monitor);
    ~MarkWindow();
    MarkWindow(const MarkWindow&) = delete;
    MarkWindow& operator=(const MarkWindow&) = delete;

    /// Shows a cross at the mark of a screen; for other touches only the text.
    void show(const display::Touch& touch, const std::string& words);
    /// Call it several times a second. False when the window was closed or Escape was pressed.
    bool draw();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tactus::render
