// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "tools/window/frame/window.hpp"

#include "devices/display/gl_program.hpp"
#include "devices/display/system_font.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/frame/cut_letters.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

namespace tactus::window {

namespace {

std::string last_error;

void keep_error(int, const char* text) { last_error = text; }

double scale_of_screen(GLFWwindow* window) {
    float across = 1.0f, down = 1.0f;
    glfwGetWindowContentScale(window, &across, &down);
    return std::clamp(static_cast<double>(across), 1.0, 4.0);
}

}  // namespace

Window::Library::Library() {
    glfwSetErrorCallback(keep_error);
    // An X server whose last window has just closed starts anew, and is not there for a moment.
    constexpr int max_tries = 5;
    bool is_there = glfwInit() == GLFW_TRUE;
    for (int tried = 1; !is_there && tried < max_tries && std::getenv("DISPLAY"); ++tried) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        is_there = glfwInit() == GLFW_TRUE;
    }
    if (!is_there)
        throw Error(
            fmt::format("no window can be opened: {}; set DISPLAY; a run without --view needs none", last_error));
}

Window::Library::~Library() { glfwTerminate(); }

Window::Window(const std::string& title, int width, int height, double scale) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale == 0.0 ? GLFW_TRUE : GLFW_FALSE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) throw Error(fmt::format("no window with OpenGL 3.3 can be opened: {}", last_error));
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    follows_screen_ = scale == 0.0;
    scale_ = scale > 0.0 ? scale : scale_of_screen(window_);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // no settings file is written
    load_fonts();
    apply_theme(scale_);
    if (!ImGui_ImplGlfw_InitForOpenGL(window_, false) || !ImGui_ImplOpenGL3_Init("#version 330"))
        throw Error("the window cannot be drawn: OpenGL 3.3 rejects the shaders");
    damage_.emplace();
    listen();
}

/// Callbacks queue; ImGui 1.86 itself would see only the state at each picture.
void Window::listen() {
    using Kind = InputEvent::Kind;
    glfwSetWindowUserPointer(window_, &listener_);
    const auto add = [](GLFWwindow* window, const InputEvent& event) {
        static_cast<Listener*>(glfwGetWindowUserPointer(window))->input.add(event);
    };
    static constexpr auto queue = add;
    static constexpr auto leave = [](GLFWwindow* w) {
        static_cast<Listener*>(glfwGetWindowUserPointer(w))->was_left = true;
    };
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* w, double x, double y) { queue(w, {Kind::move, x, y, 0, false}); });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
        if (entered) return;
        leave(w);
        queue(w, {Kind::leave, 0.0, 0.0, 0, false});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
        queue(w, {Kind::button, 0.0, 0.0, button, action == GLFW_PRESS});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) { queue(w, {Kind::wheel, x, y, 0, false}); });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int) {
        // Dear ImGui repeats keys by itself.
        if (key < 0 || action == GLFW_REPEAT) return;
        const char* const name = KeyLetters::is_printable(key) ? glfwGetKeyName(key, scancode) : nullptr;
        auto& listener = *static_cast<Listener*>(glfwGetWindowUserPointer(w));
        const bool is_down = action == GLFW_PRESS;
        // Modifiers are not repeated: a press of one is always new.
        const bool is_modifier = key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
        if (!is_modifier && !listener.held.takes(scancode, is_down)) return;
        queue(w, {Kind::key, 0.0, 0.0, listener.letters.code(key, scancode, name, is_down), is_down});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned letter) {
        queue(w, {Kind::letter, 0.0, 0.0, static_cast<int>(letter), false});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        auto& dropped = static_cast<Listener*>(glfwGetWindowUserPointer(w))->dropped;
        dropped.insert(dropped.end(), paths, paths + count);
    });
    glfwSetWindowRefreshCallback(
        window_, [](GLFWwindow* w) { static_cast<Listener*>(glfwGetWindowUserPointer(w))->is_uncovered = true; });
    glfwSetWindowCloseCallback(window_, leave);
    glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int iconified) {
        if (iconified) leave(w);
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
        if (!focused) leave(w);
        static_cast<Listener*>(glfwGetWindowUserPointer(w))->held.focus(focused != 0);
        queue(w, {Kind::focus, 0.0, 0.0, 0, focused != 0});
        ImGui_ImplGlfw_WindowFocusCallback(w, focused);
    });
}

void Window::hand_on_input() {
    ImGuiIO& io = ImGui::GetIO();
    const InputState& input = listener_.input.next(io.WantTextInput);
    constexpr float nowhere = -3.4e38f;
    const bool is_known = input.is_inside || std::ranges::any_of(input.button, [](bool down) { return down; });
    io.MousePos =
        is_known ? ImVec2(static_cast<float>(input.x), static_cast<float>(input.y)) : ImVec2(nowhere, nowhere);
    for (std::size_t i = 0; i < InputState::buttons; ++i) io.MouseDown[i] = input.button[i];
    io.MouseWheelH += static_cast<float>(input.wheel_x);
    io.MouseWheel += static_cast<float>(input.wheel_y);
    for (std::size_t i = 0; i < InputState::keys; ++i) io.KeysDown[i] = input.key[i];
    io.KeyCtrl = input.key[GLFW_KEY_LEFT_CONTROL] || input.key[GLFW_KEY_RIGHT_CONTROL];
    io.KeyShift = input.key[GLFW_KEY_LEFT_SHIFT] || input.key[GLFW_KEY_RIGHT_SHIFT];
    io.KeyAlt = input.key[GLFW_KEY_LEFT_ALT] || input.key[GLFW_KEY_RIGHT_ALT];
    io.KeySuper = input.key[GLFW_KEY_LEFT_SUPER] || input.key[GLFW_KEY_RIGHT_SUPER];
    for (const unsigned letter : input.letters) io.AddInputCharacter(letter);
    // Each edge of a button takes a picture: of slow pictures a double click takes longer than the hand did.
    constexpr float usual_s = 0.3f, pictures = 5.0f;
    io.MouseDoubleClickTime = std::max(usual_s, pictures * io.DeltaTime);
}

Window::~Window() {
    if (!window_) return;
    damage_.reset();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
}

void Window::load_fonts() {
    ImGuiIO& io = ImGui::GetIO();
    // Latin, Greek, punctuation, super- and subscripts, arrows, mathematics, shapes.
    static const ImWchar glyphs[] = {0x20,   0x17f,  0x370,  0x3ff,  0x2010, 0x205e, 0x2070, 0x209f,
                                     0x2190, 0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0};
    const auto size = static_cast<float>(std::round(14.0 * scale_));
    const std::string plain = display::system_font(false), heavy = display::system_font(true);
    if (!plain.empty() && !heavy.empty()) {
        body = io.Fonts->AddFontFromFileTTF(plain.c_str(), size, nullptr, glyphs);
        bold = io.Fonts->AddFontFromFileTTF(heavy.c_str(), size, nullptr, glyphs);
        large = io.Fonts->AddFontFromFileTTF(plain.c_str(), 2.0f * size, nullptr, glyphs);
        small = io.Fonts->AddFontFromFileTTF(plain.c_str(), std::round(11.0f * static_cast<float>(scale_)), nullptr,
                                             glyphs);
    }
    if (!body) {
        ImFontConfig config;
        config.SizePixels = size;
        body = bold = large = small = io.Fonts->AddFontDefault(&config);
    }
}

void Window::rescale(double scale) {
    scale_ = scale;
    body = bold = large = small = nullptr;
    ImGui::GetIO().Fonts->Clear();
    load_fonts();
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    damage_->forget();
    ImGui::GetStyle() = ImGuiStyle();
    apply_theme(scale_);
}

bool Window::begin() {
    glfwPollEvents();
    listener_.held.tend();
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return false;
    }
    glfwGetFramebufferSize(window_, &width_, &height_);
    if (width_ < 1 || height_ < 1) return false;
    // The window may have moved to another screen.
    if (const double scale = scale_of_screen(window_); follows_screen_ && scale != scale_) rescale(scale);
    began_s_ = glfwGetTime();
    forget_versions();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    hand_on_input();
    return true;
}

std::vector<std::uint8_t> Window::pixels() const {
    std::vector<std::uint8_t> upwards(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upwards.data());
    return upwards;
}

/// True when it drew.
bool Window::draw() {
    // The system may lose what a window showed, and its size may be news to the driver later than to GLFW.
    constexpr double all_every_s = 2.0, size_settles_s = 0.3;
    constexpr int size_settles_frames = 3;  // where a frame takes longer than that
    ImDrawData& all = *ImGui::GetDrawData();
    const double now = glfwGetTime();
    if (width_ != drawn_width_ || height_ != drawn_height_) {
        resized_s_ = now;
        unsettled_ = size_settles_frames;
    }
    drawn_width_ = width_;
    drawn_height_ = height_;
    const bool is_uncovered = std::exchange(listener_.is_uncovered, false);
    const bool is_dense = all.FramebufferScale.x != 1.0f || all.FramebufferScale.y != 1.0f;
    const bool is_settling = now - resized_s_ < size_settles_s || unsettled_ > 0;
    unsettled_ = std::max(unsettled_ - 1, 0);
    const bool draws_all = is_uncovered || is_dense || now - drawn_all_s_ > all_every_s || is_settling;
    if (draws_all) damage_->forget();
    const auto& boxes = damage_->find(all, width_, height_, ImGui::GetIO().Fonts->TexID);
    if (boxes.empty()) return false;
    const bool is_whole = draws_all || keeps_pixels_ != Keeps::yes;
    if (is_whole) drawn_all_s_ = now;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width_, height_);
    glClearColor(0.05f, 0.06f, 0.08f, 1.0f);
    if (is_whole) {
        glClear(GL_COLOR_BUFFER_BIT);
        ImGui_ImplOpenGL3_RenderDrawData(&all);
        return true;
    }
    glEnable(GL_SCISSOR_TEST);
    for (const PixelBox& box : boxes) {
        glScissor(box.left, height_ - box.bottom, box.right - box.left, box.bottom - box.top);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    ImGui_ImplOpenGL3_RenderDrawData(&damage_->part());
    return true;
}

/// Whether a window's buffer still holds its pixels after it was shown is up to the driver: without a graphics card it
/// does.
void Window::show() {
    if (keeps_pixels_ != Keeps::unknown) return glfwSwapBuffers(window_);
    const std::vector<std::uint8_t> before = pixels();
    glfwSwapBuffers(window_);
    keeps_pixels_ = display::is_software_driver() && pixels() == before ? Keeps::yes : Keeps::no;
}

void Window::read_picture() {
    const std::vector<std::uint8_t> upwards = pixels();
    const auto row = static_cast<std::size_t>(width_) * 3;
    shown_.width = width_;
    shown_.height = height_;
    shown_.rgb.resize(upwards.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y)
        std::copy_n(upwards.data() + y * row, row,
                    shown_.rgb.data() + (static_cast<std::size_t>(height_) - 1 - y) * row);
}

void Window::end() {
    ImGui::Render();
    write_cut_letters();
    if (wants_picture_ && keeps_pixels_ != Keeps::yes) damage_->forget();
    const bool is_new = draw();
    if (std::exchange(wants_picture_, false)) read_picture();
    if (is_new) show();
    drawn_s_ += glfwGetTime() - began_s_;
}

bool Window::wants_to_close() const { return glfwWindowShouldClose(window_) != 0; }
void Window::keep_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }
void Window::resize(int width, int height) { glfwSetWindowSize(window_, width, height); }
void Window::minimise(bool wanted) {
    if (wanted) glfwIconifyWindow(window_);
    else glfwRestoreWindow(window_);
}
void Window::want_picture() { wants_picture_ = true; }

}  // namespace tactus::window
