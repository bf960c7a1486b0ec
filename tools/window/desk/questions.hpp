// SPDX-License-Identifier: Apache-2.0
// Dialogs about unsaved work: when a patch or a plan is left, and when it is opened.
#pragma once

#include "tools/window/document/plan_document.hpp"
#include "tools/window/document/workbench.hpp"

#include <functional>

namespace tactus::window {

class Questions {
public:
    explicit Questions(Workbench& bench) : bench_(bench) {}

    /// The opened plan, or null.
    void use(PlanDocument* plan) { plan_ = plan; }
    /// Saves the plan; false: it was not saved, or needs a name first.
    std::function<bool()> save_plan;

    /// Something is unsaved that was not dropped.
    bool has_unsaved() const { return bench_.has_unsaved_edits() || (plan_ && plan_->has_unsaved_steps()); }
    /// Revokes "Don't save" when the user cancels leaving.
    void want_all();
    /// Draws the dialogs on top of everything.
    void draw();
    /// Called when the file-name dialog closes: continues leaving if the document was saved, otherwise stays.
    void named(bool is_saved);

    /// Dialog before a patch is left: save, do not save, or stay? `saves`: waits for a file name.
    enum class Leaving { none, asks, saves, leaves } leaving = Leaving::none;
    bool has_restored = false;  ///< edits, since the owner looked

private:
    void ask_leaving();
    void ask_leaving_plan();
    void offer_edits();
    void offer_steps();
    Leaving after_saving() const { return has_unsaved() ? Leaving::asks : Leaving::leaves; }

    Workbench& bench_;
    PlanDocument* plan_ = nullptr;
};

}  // namespace tactus::window
