// SPDX-License-Identifier: Apache-2.0
#include "devices/display/picture_maker.hpp"

#include "devices/display/gl_program.hpp"
#include "dsp/core/error.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <fmt/format.h>

#include <algorithm>

namespace tactus::display {

namespace {

constexpr int max_pixels_per_side = 8192;

int checked(int width, int height) {
    if (width < 1 || height < 1 || width > max_pixels_per_side || height > max_pixels_per_side)
        throw Error(fmt::format("a picture cannot have {} x {} pixels; each side must be 1 to {}", width, height,
                                max_pixels_per_side));
    return width;
}

void attach(GLuint buffer, GLenum where, GLenum kind, int samples, int width, int height) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, kind, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
}

void check_frame(int width, int height) {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("the graphics driver cannot make a picture of {} x {} pixels", width, height));
}

}  // namespace

PictureMaker::PictureMaker(int width, int height) : width_(checked(width, height)), height_(height) {
    GLint max_samples = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
    glGenRenderbuffers(3, buffers_);
    glGenFramebuffers(1, &resolved_);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    attach(buffers_[0], GL_COLOR_ATTACHMENT0, GL_RGBA8, 0, width, height);
    check_frame(width, height);
    glGenFramebuffers(1, &frame_);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    const int samples = std::min(max_samples, 4);
    attach(buffers_[1], GL_COLOR_ATTACHMENT0, GL_RGBA8, samples, width, height);
    attach(buffers_[2], GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, samples, width, height);
    check_frame(width, height);
    renderer_ = std::make_unique<SceneRenderer>();
}

// Objects are deleted together with their context.
PictureMaker::~PictureMaker() = default;

Image PictureMaker::draw(const Picture& picture, std::span<const DrawnView> views) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glViewport(0, 0, width_, height_);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    renderer_->draw(picture, views);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const std::size_t row = 3 * static_cast<std::size_t>(width_);
    Image image{width_, height_, std::vector<std::uint8_t>(row * static_cast<std::size_t>(height_))};
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw Error(fmt::format("the graphics driver reports error {:#x} for a picture", error));
    // OpenGL's first row is the bottom row.
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(height_) - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(image.rgb.data() + top * row, image.rgb.data() + (top + 1) * row,
                         image.rgb.data() + bottom * row);
    return image;
}

}  // namespace tactus::display
