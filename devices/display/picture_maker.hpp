// SPDX-License-Identifier: Apache-2.0
// Offscreen images of a scene.
#pragma once

#include "devices/display/gl_context.hpp"
#include "devices/display/offscreen.hpp"
#include "devices/display/scene_renderer.hpp"

#include <cstdint>
#include <span>

namespace tactus::display {

/// Owns an OpenGL context that is current in its thread during its lifetime.
class PictureMaker {
public:
    /// Throws Error if there is no OpenGL context, and for a size outside 1 to 8192 pixels.
    PictureMaker(int width, int height);
    ~PictureMaker();

    SceneRenderer& renderer() { return *renderer_; }
    int width() const { return width_; }
    int height() const { return height_; }

    /// Four samples per pixel if the driver supports it. Deterministic on one machine.
    Image draw(const Picture& picture, std::span<const DrawnView> views);

private:
    int width_, height_;
    SurfacelessContext context_;
    std::uint32_t frame_ = 0, resolved_ = 0, buffers_[3] = {};
    std::unique_ptr<SceneRenderer> renderer_;
};

}  // namespace tactus::display
