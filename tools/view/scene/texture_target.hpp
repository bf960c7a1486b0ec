// SPDX-License-Identifier: Apache-2.0
// A picture on the graphics card that a panel shows: drawn into with smooth edges, then a texture.
#pragma once

#include "devices/display/offscreen.hpp"
#include "dsp/display/screen.hpp"

#include <cstdint>

namespace tactus::view {

/// Of one OpenGL context, which must be current in every call.
class TextureTarget {
public:
    TextureTarget() = default;
    ~TextureTarget();
    TextureTarget(const TextureTarget&) = delete;
    TextureTarget& operator=(const TextureTarget&) = delete;

    /// From here on everything is drawn into it, with up to `samples` per pixel. A new size makes it anew. Throws Error.
    void begin(int width, int height, int samples = 4);
    /// Gives the window back and resolves what was drawn.
    void end();

    /// After `end`: puts an image on top, its lower left corner at (x, y) from the lower left.
    void lay(const display::Image& image, int x, int y, display::Flip flip);

    std::uint32_t texture() const { return texture_; }  ///< its first row is the lowest
    int width() const { return width_; }
    int height() const { return height_; }

private:
    void make(int width, int height, int samples);
    void remove();

    int width_ = 0, height_ = 0, samples_ = 0;
    std::uint32_t frame_ = 0, resolved_ = 0, texture_ = 0, buffers_[2] = {};
};

}  // namespace tactus::view
