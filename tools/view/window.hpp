// SPDX-License-Identifier: Apache-2.0
// A window with OpenGL 3.3 and Dear ImGui in it. All calls from the thread that made it.
#pragma once

#include "devices/display/offscreen.hpp"

#include <memory>
#include <string>

struct GLFWwindow;
struct ImFont;

namespace tactus::view {

class Window {
public:
    /// `scale` of what is in it, 0: as the screen says. Throws Error when there is no display or no OpenGL 3.3.
    Window(const std::string& title, int width, int height, double scale);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Takes in input. False while it is minimised: then nothing is to be drawn, and a moment was waited.
    bool begin();
    /// Shows what was drawn; waits for the screen.
    void end();

    bool wants_to_close() const;
    void keep_open();
    /// As its frame's button does.
    void close();
    void set_title(const std::string& title);
    void resize(int width, int height);
    void minimise(bool wanted);
    /// Contents of another size, as on a screen with other pixels. Before `begin`.
    void rescale(double scale);
    int width() const { return width_; }  ///< pixels
    int height() const { return height_; }
    double scale() const { return scale_; }
    /// Spent between `begin` and `end` so far, s.
    double drawn_s() const { return drawn_s_; }
    /// Keeps what the next `end` shows, in `picture`.
    void want_picture();
    const display::Image& picture() const { return shown_; }

    ImFont* body = nullptr;
    ImFont* bold = nullptr;
    ImFont* large = nullptr;  ///< twice the size, for what is magnified

private:
    void load_fonts();

    struct Library {
        Library();
        ~Library();
    };
    Library library_;
    GLFWwindow* window_ = nullptr;
    int width_ = 0, height_ = 0;
    double scale_ = 1.0;
    bool follows_screen_ = false;  // its scale
    double began_s_ = 0.0, drawn_s_ = 0.0;
    display::Image shown_;
    bool wants_picture_ = false;
};

}  // namespace tactus::view
