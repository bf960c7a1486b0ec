// SPDX-License-Identifier: Apache-2.0
// An anti-aliased render target that becomes a texture for a panel.
#pragma once

#include "devices/display/offscreen.hpp"
#include "dsp/display/screen.hpp"

#include <cstdint>

namespace tactus::window {

/// Belongs to one OpenGL context, which must be current in every call.
class TextureTarget {
public:
    TextureTarget() = default;
    ~TextureTarget();
    TextureTarget(const TextureTarget&) = delete;
    TextureTarget& operator=(const TextureTarget&) = delete;

    /// Redirects drawing into it, with up to `samples` per pixel. A new size reallocates it. Throws Error.
    void begin(int width, int height, int samples = 4);
    /// Redirects drawing into it again, after `pause`; what is in it stays.
    void resume();
    /// Restores the window's framebuffer; the texture has not what was drawn since `begin`, before `end`.
    void pause();
    /// Restores the window's framebuffer and resolves the samples, if there are several.
    void end();

    /// After `end`: draws an image on top, with its lower left corner at (x, y).
    void lay(const display::Image& image, int x, int y, display::Flip flip);

    std::uint32_t texture() const { return texture_; }  ///< first row at the bottom
    /// Another number after each `end`, of all targets.
    std::uint64_t version() const { return version_; }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    void make(int width, int height, int samples);
    void remove();

    int width_ = 0, height_ = 0, samples_ = 0;
    std::uint64_t version_ = 0;
    std::uint32_t frame_ = 0, resolved_ = 0, texture_ = 0, buffers_[2] = {};
};

}  // namespace tactus::window
