// SPDX-License-Identifier: Apache-2.0
// Commands on the screen: menus, keys, the list of Ctrl+P and the table of F1.
#pragma once

#include "tools/window/frame/commands.hpp"
#include "tools/window/widgets/canvas.hpp"
#include "tools/window/widgets/painter.hpp"

#include <string>
#include <vector>

namespace tactus::window {

/// Menus of all commands, on the current line; one button when there is less room than `room`, pixels. `wants_all` opens one
/// menu that has all of them, for the keyboard.
void draw_menus(const std::vector<Command>& commands, double room, bool wants_all);

/// Runs the command whose keys are pressed in this frame. `is_typing`: a text field has the keys that mean something
/// in it.
void run_pressed(const std::vector<Command>& commands, bool is_typing);

class CommandList {
public:
    /// Opens the list; `all`: what it offers until it closes.
    void open(std::vector<Command> all);
    void open_help() { wants_help_ = true; }
    /// `commands`: for the table of keys.
    void draw(const std::vector<Command>& commands, const Fonts& fonts);
    bool is_open() const { return is_open_; }

private:
    void draw_list(const Fonts& fonts);

    std::vector<Command> all_;
    std::vector<const Command*> found_;
    std::string words_;
    std::size_t chosen_ = 0;
    Point help_size_;
    bool wants_open_ = false, wants_help_ = false, is_open_ = false;
};

}  // namespace tactus::window
