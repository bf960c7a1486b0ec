// SPDX-License-Identifier: Apache-2.0
// A window with nothing but the picture of one screen in it: a projector, a stereo monitor, a tablet under a mirror.
#pragma once

#include <array>
#include <cstdint>
#include <string>

struct GLFWwindow;

namespace tactus::view {

/// Shows textures of the context that was current when it was made, and which is so again after every call.
class ScreenWindow {
public:
    struct Place {
        int monitor = 0;              ///< from 1: all of it; 0: none
        std::array<int, 4> window{};  ///< x, y, width, height in pixels of the desktop; width 0: somewhere
        bool has_two_buffers = false;  ///< one for each eye
    };
    /// Throws Error when there is no such monitor, or no driver with a buffer for each eye where two are wanted.
    ScreenWindow(const std::string& title, const Place& place);
    ~ScreenWindow();
    ScreenWindow(const ScreenWindow&) = delete;
    ScreenWindow& operator=(const ScreenWindow&) = delete;

    int width() const { return width_; }  ///< pixels, as of the last `show`
    int height() const { return height_; }
    /// Fills it with a texture of that size; `right` is the other eye's, or 0. `is_first`: waits for the screen.
    void show(std::uint32_t left, std::uint32_t right, int width, int height, bool is_first);
    /// Its close button or Escape was pressed.
    bool wants_to_close() const;

private:
    GLFWwindow* window_ = nullptr;
    std::uint32_t frame_ = 0;
    int width_ = 0, height_ = 0, waits_ = -1;
};

}  // namespace tactus::view
