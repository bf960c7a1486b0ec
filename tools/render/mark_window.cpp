// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "tools/render/mark_window.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::render {

namespace {

void fill(int x, int y, int width, int height, float grey) {
    glScissor(x, y, width, height);
    glClearColor(grey, grey, grey, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

void draw_mark(const display::Touch& touch, int width, int height) {
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    fill(0, 0, width, height, 0.06f);
    if (touch.of == display::Touch::Of::screen || touch.of == display::Touch::Of::image) {
        // Thin at the crossing, so that the position is exact.
        const int x = static_cast<int>(std::lround(touch.shown.x * width)),
                  y = static_cast<int>(std::lround(touch.shown.y * height)), reach = height / 20;
        fill(x - reach, y - 1, 2 * reach, 2, 1.0f);
        fill(x - 1, y - reach, 2, 2 * reach, 1.0f);
        fill(x - reach, y - 4, reach / 2, 8, 1.0f);
        fill(x + reach / 2, y - 4, reach / 2, 8, 1.0f);
    }
    glDisable(GL_SCISSOR_TEST);
}

struct MarkWindow::State {
    GLFWwindow* window = nullptr;
    display::Touch touch;

    ~State() {
        if (window) glfwDestroyWindow(window);
        glfwTerminate();
    }
};

MarkWindow::MarkWindow(int number) {
    if (!glfwInit()) throw Error("--show: there is no display for the marks; set DISPLAY, or leave it out");
    state_ = std::make_unique<State>();
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    if (number > count) throw Error(fmt::format("--show {}: there are {} monitors", number, count));
    GLFWmonitor* const monitor = monitors[number - 1];
    const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
    state_->window = glfwCreateWindow(mode->width, mode->height, "Tactus", monitor, nullptr);
    if (!state_->window) throw Error("--show: no window with OpenGL 3.3 can be opened for the marks");
    glfwMakeContextCurrent(state_->window);
    glfwSwapInterval(1);
}

MarkWindow::~MarkWindow() = default;

void MarkWindow::show(const display::Touch& touch, const std::string& words) {
    state_->touch = touch;
    glfwSetWindowTitle(state_->window, words.c_str());
}

bool MarkWindow::draw() {
    glfwPollEvents();
    if (glfwWindowShouldClose(state_->window) || glfwGetKey(state_->window, GLFW_KEY_ESCAPE) == GLFW_PRESS)
        return false;
    int width = 0, height = 0;
    glfwGetFramebufferSize(state_->window, &width, &height);
    draw_mark(state_->touch, width, height);
    glfwSwapBuffers(state_->window);
    return true;
}

}  // namespace tactus::render
