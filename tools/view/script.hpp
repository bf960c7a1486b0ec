// SPDX-License-Identifier: Apache-2.0
// What is done in the window, line by line from a file: for tests, and for the pictures of the documentation.
#pragma once

#include "tools/view/canvas.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::view {

class Desk;
class Window;

class Script {
public:
    /// Throws Error when the file cannot be read or a line has no known command.
    explicit Script(const std::filesystem::path& file);

    /// Opens another patch, or a take, in the same window.
    std::function<void(const std::string& patch)> open;

    /// After each picture: does what comes next, up to the next line that takes its time. Throws Error where one fails;
    /// one that begins with '!' must be refused.
    void step(Desk& desk, Window& window);
    /// Before each picture: where the mouse is.
    void move_mouse() const;
    bool is_done() const { return next_ >= lines_.size(); }
    bool wants_to_close() const { return closes_; }

    /// What stands on a keyboard.
    struct Keys {
        std::string text;
        int key = -1;
        bool is_active = false, is_down = false, ctrl = false;
    };

private:
    struct Line {
        int number = 0;
        bool is_refused = false;
        std::vector<std::string> words;
    };
    struct Mouse {
        Point at;
        bool left = false, right = false;
        double wheel = 0.0;
    };

    /// "ctrl+z", "enter", "delete", "space" or a letter. Throws Error.
    static Keys key_named(const std::string& name);
    /// False: not done yet, asks again after the next picture.
    bool perform(const Line& line, Desk& desk, Window& window);
    bool edit(const Line& line, Desk& desk);
    bool use_hand(const Line& line, Desk& desk);
    bool wait_for(const Line& line, Desk& desk, Window& window);
    const std::string& word(const Line& line, std::size_t i) const;
    double number(const Line& line, std::size_t i) const;

    std::filesystem::path file_;
    std::vector<Line> lines_;
    std::size_t next_ = 0;
    std::optional<double> since_;  ///< when the line that waits began, s
    int pictures_ = 0;  ///< since then
    std::optional<Mouse> mouse_;
    Point from_, to_;  ///< of the hand
    Keys keys_;
    double cost_began_ = 0.0;
    bool closes_ = false;
};

}  // namespace tactus::view
