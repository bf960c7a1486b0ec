// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/texture_target.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace tactus::window {

TextureTarget::~TextureTarget() { remove(); }

void TextureTarget::remove() {
    if (!frame_) return;
    glDeleteFramebuffers(1, &frame_);
    glDeleteFramebuffers(1, &resolved_);
    glDeleteRenderbuffers(2, buffers_);
    glDeleteTextures(1, &texture_);
    frame_ = resolved_ = 0;
}

void TextureTarget::make(int width, int height, int wanted) {
    remove();
    width_ = width;
    height_ = height;
    samples_ = wanted;
    GLint max_samples = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
    const int samples = std::min(max_samples, wanted);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glGenFramebuffers(1, &frame_);
    const auto is_complete = [] { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; };
    const auto attach = [&](GLuint buffer, GLenum where, GLenum kind) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, kind, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
    };
    bool good = true;
    glGenRenderbuffers(2, buffers_);
    if (samples > 1) {
        glGenFramebuffers(1, &resolved_);
        glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
        good = is_complete();
    }
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    if (samples > 1) attach(buffers_[0], GL_COLOR_ATTACHMENT0, GL_RGBA8);
    else glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    attach(buffers_[1], GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24);
    if (!good || !is_complete())
        throw Error(fmt::format("the graphics driver cannot make a picture of {} x {} pixels", width, height));
}

void TextureTarget::begin(int width, int height, int samples) {
    if (!frame_ || width != width_ || height != height_ || samples != samples_) make(width, height, samples);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void TextureTarget::resume() {
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glViewport(0, 0, width_, height_);
}

void TextureTarget::pause() { glBindFramebuffer(GL_FRAMEBUFFER, 0); }

void TextureTarget::end() {
    static std::uint64_t pictures = 0;
    version_ = ++pictures;
    if (resolved_ == 0) return glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void TextureTarget::lay(const display::Image& image, int x, int y, display::Flip flip) {
    const int left = std::max(x, 0), low = std::max(y, 0);
    const int wide = std::min(x + image.width, width_) - left, high = std::min(y + image.height, height_) - low;
    if (wide < 1 || high < 1) return;
    // OpenGL's first row is the bottom row, an image's the top row.
    std::vector<std::uint8_t> part;
    part.reserve(3 * static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
    for (int v = low; v < low + high; ++v)
        for (int u = left; u < left + wide; ++u) {
            const int across = flip == display::Flip::left_right ? image.width - 1 - (u - x) : u - x;
            const int down = flip == display::Flip::upside_down ? v - y : image.height - 1 - (v - y);
            const std::uint8_t* const pixel = image.pixel(across, down);
            part.insert(part.end(), pixel, pixel + 3);
        }
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, left, low, wide, high, GL_RGB, GL_UNSIGNED_BYTE, part.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

}  // namespace tactus::window
