// SPDX-License-Identifier: Apache-2.0
// A window with OpenGL 3.3 and Dear ImGui. All calls on the creating thread.
#pragma once

#include "devices/display/offscreen.hpp"
#include "tools/window/frame/damage.hpp"
#include "tools/window/frame/held_keys.hpp"
#include "tools/window/frame/input_queue.hpp"
#include "tools/window/frame/key_letters.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;
struct ImFont;

namespace tactus::window {

class Window {
public:
    /// `scale`: of the content, 0: that of the screen. Throws Error without a display or OpenGL 3.3.
    Window(const std::string& title, int width, int height, double scale);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Processes input. False while minimised: it has then waited for a moment, and nothing is drawn.
    bool begin();
    /// Draws what differs from the frame before, and shows it; waits for vertical sync. A frame that does not differ is
    /// not shown again.
    void end();

    bool wants_to_close() const;
    void keep_open();
    /// Same as the close button.
    void close();
    void set_title(const std::string& title);
    void resize(int width, int height);
    void minimise(bool wanted);
    /// Changes the scale of the content. Call it before `begin`.
    void rescale(double scale);
    int width() const { return width_; }  ///< pixels
    int height() const { return height_; }
    double scale() const { return scale_; }
    /// Total time between `begin` and `end`, s.
    double drawn_s() const { return drawn_s_; }
    /// Files dropped on the window since the last call.
    std::vector<std::string> take_dropped() { return std::exchange(listener_.dropped, {}); }
    /// True when, since the last call, the pointer or the keys went to another window, or this one was minimised; and then
    /// until a picture has seen it, so that keys pressed before do not count after it.
    bool take_left() { return std::exchange(listener_.was_left, listener_.input.waits_to_leave()); }
    /// Captures the next frame in `picture`.
    void want_picture();
    const display::Image& picture() const { return shown_; }

    ImFont* body = nullptr;
    ImFont* bold = nullptr;
    ImFont* small = nullptr;  ///< for the smallest text
    ImFont* large = nullptr;  ///< twice the size, for magnified text

private:
    void load_fonts();
    void listen();
    void hand_on_input();
    bool draw();
    void show();
    void read_picture();
    std::vector<std::uint8_t> pixels() const;

    struct Library {
        Library();
        ~Library();
    };
    Library library_;
    GLFWwindow* window_ = nullptr;
    struct Listener {
        InputQueue input;
        KeyLetters letters;
        HeldKeys held;
        std::vector<std::string> dropped;
        bool was_left = false;  // at once, not after the events that wait
        bool is_uncovered = false;  // another window lay over it
    };
    Listener listener_;
    int width_ = 0, height_ = 0;
    double scale_ = 1.0;
    bool follows_screen_ = false;  // its scale
    double began_s_ = 0.0, drawn_s_ = 0.0;
    display::Image shown_;
    bool wants_picture_ = false;
    std::optional<Damage> damage_;
    enum class Keeps { unknown, yes, no } keeps_pixels_ = Keeps::unknown;  // of a frame that was shown
    int drawn_width_ = 0, drawn_height_ = 0;
    int unsettled_ = 0;  // frames to draw as a whole after a new size
    double drawn_all_s_ = -1e9, resized_s_ = -1e9;
};

}  // namespace tactus::window
