// SPDX-License-Identifier: Apache-2.0
// What the window asks about edits that are not saved: when it is to be closed, when it opens, and for a name.
#pragma once

#include "tools/view/workbench.hpp"

#include <array>
#include <string>

namespace tactus::view {

class Questions {
public:
    explicit Questions(Workbench& bench) : bench_(bench) {}

    /// Within a picture, above all else.
    void draw();

    /// The window is to be closed: save, do not save, or keep it open?
    enum class Leaving { none, asks, leaves } leaving = Leaving::none;

private:
    void ask_leaving();
    void ask_name();
    void offer_edits();

    Workbench& bench_;
    std::array<char, 1024> name_{};
    std::string problem_;  // with the name that was given last
    bool leaves_when_saved_ = false;
};

}  // namespace tactus::view
