// SPDX-License-Identifier: Apache-2.0
// Runs commands of the painting window from a file, line by line: for tests and pictures.
#pragma once

#include "tools/window/files/script_line.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class PaintDesk;
class Window;

/// Commands; positions in mm, LPS. A line that begins with ! must be refused by the painting:
///
///     label NAME            paints this label; makes it if there is none
///     brush MM              radius
///     stroke X Y Z ...      paints along the positions; one position is a dab
///     erase X Y Z ...
///     remove NAME, rename NAME NEW, merge NAME INTO, undo, redo
///     cursor X Y Z, grey LOW HIGH, zoom FACTOR, from VIEW
///     look                  look here
///     island                next island without a seed
///     tool NAME             paint, erase or vessel
///     vessel X Y Z          follows a vessel
///     click_bone X Y Z      a click on the bone's picture, at the pixel of this place
///     plan                  makes a plan
///     until solved          waits until nothing is being computed, at most 300 s
///     until there FILE      waits for a file
///     press NAME, drag X Y X Y, wheel X Y TURNS   with the mouse; NAME: of a button or panel
///     spots FILE            writes where the controls are
///     shut                  closes the window as its button does
///     size W H, frames N, wait S, screenshot FILE, close
class PaintScript {
public:
    /// Throws Error when the file cannot be read, and as paint_lines().
    explicit PaintScript(const std::filesystem::path& file);

    /// Called after each frame: runs the next lines up to one that must wait. Throws Error when a line fails.
    void step(PaintDesk& desk, Window& window);
    /// The mouse, before each frame.
    void move_mouse() const;
    bool wants_to_close() const { return closes_; }

private:
    bool perform(const ScriptLine& line, PaintDesk& desk, Window& window);
    bool edit(const ScriptLine& line, PaintDesk& desk);
    bool use_mouse(const ScriptLine& line);

    std::vector<ScriptLine> lines_;
    std::size_t next_ = 0;
    int frames_ = 0;
    double since_ = -1.0;
    bool closes_ = false;
    struct Mouse {
        Point at;
        bool left = false;
        double wheel = 0.0;
    };
    std::optional<Mouse> mouse_;
    Point from_, to_;
};

}  // namespace tactus::window
