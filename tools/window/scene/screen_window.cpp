// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "tools/window/scene/screen_window.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::window {

namespace {

GLFWwindow* open(const std::string& title, const ScreenWindow::Place& place, GLFWwindow* beside) {
    GLFWmonitor* monitor = nullptr;
    int width = place.window[2] > 0 ? place.window[2] : 960, height = place.window[3] > 0 ? place.window[3] : 600;
    if (place.monitor > 0) {
        int count = 0;
        GLFWmonitor** const all = glfwGetMonitors(&count);
        if (place.monitor > count)
            throw Error(fmt::format("{} is for monitor {}; there {} {}", title, place.monitor,
                                    count == 1 ? "is only" : "are", count));
        monitor = all[place.monitor - 1];
        const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
        width = mode->width;
        height = mode->height;
    }
    glfwWindowHint(GLFW_STEREO, place.has_two_buffers ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DECORATED, place.window[2] > 0 ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
    GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), monitor, beside);
    glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
    glfwWindowHint(GLFW_DECORATED, GLFW_TRUE);
    if (window && place.window[2] > 0 && !monitor) glfwSetWindowPos(window, place.window[0], place.window[1]);
    return window;
}

}  // namespace

ScreenWindow::ScreenWindow(const std::string& title, const Place& place) {
    GLFWwindow* const beside = glfwGetCurrentContext();
    window_ = open(title, place, beside);
    bool has_two = false;
    if (window_) {
        glfwMakeContextCurrent(window_);
        GLboolean stereo = GL_FALSE;
        glGetBooleanv(GL_STEREO, &stereo);
        has_two = stereo == GL_TRUE;
        glGenFramebuffers(1, &frame_);
        glfwMakeContextCurrent(beside);
    }
    if (window_ && (has_two || !place.has_two_buffers)) return;
    if (window_) glfwDestroyWindow(std::exchange(window_, nullptr));
    if (place.has_two_buffers)
        throw Error(
            "this graphics driver has no quad-buffered stereo (a buffer for each eye); choose side by side or "
            "anaglyph");
    throw Error(fmt::format("no window can be opened for {}", title));
}

ScreenWindow::~ScreenWindow() {
    if (!window_) return;
    GLFWwindow* const beside = glfwGetCurrentContext();
    glfwMakeContextCurrent(window_);
    glDeleteFramebuffers(1, &frame_);
    glfwMakeContextCurrent(beside == window_ ? nullptr : beside);
    glfwDestroyWindow(window_);
}

void ScreenWindow::show(std::uint32_t left, std::uint32_t right, int width, int height, bool is_first) {
    GLFWwindow* const beside = glfwGetCurrentContext();
    glFlush();
    glfwMakeContextCurrent(window_);
    glfwGetFramebufferSize(window_, &width_, &height_);
    if (std::exchange(waits_, is_first ? 1 : 0) != waits_) glfwSwapInterval(is_first ? 1 : 0);
    const auto copy = [&](std::uint32_t texture, GLenum buffer) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
        glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glDrawBuffer(buffer);
        glBlitFramebuffer(0, 0, width, height, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    };
    if (width_ > 0 && height_ > 0) {
        copy(left, right ? GL_BACK_LEFT : GL_BACK);
        if (right) copy(right, GL_BACK_RIGHT);
        glfwSwapBuffers(window_);
    }
    glfwMakeContextCurrent(beside);
}

bool ScreenWindow::wants_to_close() const {
    return glfwWindowShouldClose(window_) || glfwGetKey(window_, GLFW_KEY_ESCAPE) == GLFW_PRESS;
}

}  // namespace tactus::window
