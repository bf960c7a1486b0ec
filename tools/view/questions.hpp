// SPDX-License-Identifier: Apache-2.0
// Dialogs about unsaved edits: when the window closes, when it opens, and for a file name.
#pragma once

#include "tools/view/workbench.hpp"

#include <array>
#include <string>

namespace tactus::view {

class Questions {
public:
    explicit Questions(Workbench& bench) : bench_(bench) {}

    /// Draws the dialogs on top of everything.
    void draw();

    /// Dialog when the window closes: save, do not save, or keep it open?
    enum class Leaving { none, asks, leaves } leaving = Leaving::none;

private:
    void ask_leaving();
    void ask_name();
    void offer_edits();

    Workbench& bench_;
    std::array<char, 1024> name_{};
    std::string problem_;  // problem of the last entered name
    bool leaves_when_saved_ = false;
};

}  // namespace tactus::view
