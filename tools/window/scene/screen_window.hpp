// SPDX-License-Identifier: Apache-2.0
// A window with the picture of one screen: a projector, a stereo monitor, a tablet under a mirror.
#pragma once

#include <array>
#include <cstdint>
#include <string>

struct GLFWwindow;

namespace tactus::window {

/// Shows textures of the OpenGL context that was current at its creation. Every call restores that context.
class ScreenWindow {
public:
    struct Place {
        int monitor = 0;              ///< full screen on this monitor, from 1; 0: none
        std::array<int, 4> window{};  ///< x, y, width, height in pixels of the desktop; width 0: default position
        bool has_two_buffers = false;  ///< quad-buffered: one buffer per eye
    };
    /// Throws Error when the monitor does not exist, or when the driver does not support quad-buffering.
    ScreenWindow(const std::string& title, const Place& place);
    ~ScreenWindow();
    ScreenWindow(const ScreenWindow&) = delete;
    ScreenWindow& operator=(const ScreenWindow&) = delete;

    int width() const { return width_; }  ///< pixels, as of the last `show`
    int height() const { return height_; }
    /// Shows a texture of that size; `right`: texture of the right eye, or 0. `is_first`: waits for vertical sync.
    void show(std::uint32_t left, std::uint32_t right, int width, int height, bool is_first);
    /// True when its close button or Escape was pressed.
    bool wants_to_close() const;

private:
    GLFWwindow* window_ = nullptr;
    std::uint32_t frame_ = 0;
    int width_ = 0, height_ = 0, waits_ = -1;
};

}  // namespace tactus::window
