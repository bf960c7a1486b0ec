// SPDX-License-Identifier: Apache-2.0
// Dialogs about unsaved edits: when a patch is left, and when it is opened.
#pragma once

#include "tools/window/document/workbench.hpp"

namespace tactus::window {

class Questions {
public:
    explicit Questions(Workbench& bench) : bench_(bench) {}

    /// Draws the dialogs on top of everything.
    void draw();
    /// The dialog for a file name is closed: who leaves when the patch is saved, leaves or stays.
    void named(bool is_saved);

    /// Dialog before a patch is left: save, do not save, or stay? `saves`: waits for a file name.
    enum class Leaving { none, asks, saves, leaves } leaving = Leaving::none;
    bool has_restored = false;  ///< edits, since the owner looked

private:
    void ask_leaving();
    void offer_edits();

    Workbench& bench_;
};

}  // namespace tactus::window
