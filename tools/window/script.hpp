// SPDX-License-Identifier: Apache-2.0
// Runs window commands from a file, line by line: for tests, and for the pictures of the documentation.
#pragma once

#include "tools/window/files/script_line.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class Desk;
class Window;

class Script {
public:
    /// Throws Error when the file cannot be read or a command is unknown.
    explicit Script(const std::filesystem::path& file);

    /// Callback that opens another patch or take in the same window.
    std::function<void(const std::string& patch)> open;

    /// Called after each frame: runs the next lines up to one that must wait. Throws Error when a line fails; a line
    /// that begins with '!' must be refused.
    void step(Desk& desk, Window& window);
    /// The mouse state, queried before each frame.
    void move_mouse() const;
    bool is_done() const { return next_ >= lines_.size(); }
    bool wants_to_close() const { return closes_; }

    /// Keyboard state.
    struct Keys {
        std::string text;
        int key = -1;
        bool is_active = false, is_down = false, ctrl = false;
    };

private:
    struct Mouse {
        Point at;
        bool left = false, right = false;
        double wheel = 0.0;
    };

    /// "ctrl+z", "enter", "delete", "space" or a letter. Throws Error.
    static Keys key_named(const std::string& name);
    /// False: not finished; called again after the next frame.
    bool perform(const ScriptLine& line, Desk& desk, Window& window);
    bool edit(const ScriptLine& line, Desk& desk);
    bool use_hand(const ScriptLine& line, Desk& desk);
    bool wait_for(const ScriptLine& line, Desk& desk, Window& window);

    std::vector<ScriptLine> lines_;
    std::size_t next_ = 0;
    std::optional<double> since_;  ///< start of the waiting line, s
    int pictures_ = 0;  ///< since then
    std::optional<Mouse> mouse_;
    Point from_, to_;  ///< motion of the mouse
    Keys keys_;
    double cost_began_ = 0.0;
    bool closes_ = false;
};

}  // namespace tactus::window
