// SPDX-License-Identifier: Apache-2.0
// The reconstruction of a plan: plates, implants, vessels, sites and margin, which can be added, changed and removed, and
// the verdicts of the plan as it is now.
#pragma once

#include "tools/window/plan/flap_run.hpp"
#include "tools/window/scene/scene_panel.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::window {

class FlapPanel {
public:
    FlapPanel(Workbench& bench, CaseRun& run, ScenePanel& scene)
        : bench_(bench), run_(run), flap_(bench, run), scene_(scene) {}

    /// Once per picture, also while it is not drawn: the scene shows what the plan has now.
    void tend();
    /// Draws nothing for a plan without a reconstruction.
    void draw();
    /// Once per picture, also while it is not drawn: a form that a command asks for.
    void draw_question() { dialog(); }
    FlapRun& flap() { return flap_; }
    /// What commands open: the forms of a new guide and of the skin paddle.
    void ask_guide();
    void ask_paddle();

private:
    enum class Kind { plate, implant, vessel, site, margin, guide, paddle };
    /// What is asked for in the dialog; mm.
    struct Form {
        Kind kind = Kind::plate;
        std::string of;  ///< the name of what is changed; empty: a new one
        std::string name, file, note;
        std::array<float, 3> at{}, axis{0.0f, 0.0f, -1.0f};
        float diameter = 4.0f, length = 14.0f, screw_length = 12.0f, height = 0.0f, margin = 10.0f;
        int screws = 2;
        bool is_vein = false;
        float paddle_length = 60.0f, paddle_width = 40.0f, turn = 0.0f;  ///< turn: degrees
        int bone = 0, cut = 0, sides = 3;  ///< bone: 0 the fibula, 1 the jaw
        std::string label;
        bool is_at_perforators = true;
    };
    void open(Form form);
    void lists(const reconstruction::Reconstruction& all);
    void dialog();
    void places();
    /// False: not now, and the form stays.
    bool apply();
    /// A line of a list: its name, which opens the dialog, and a button that removes it.
    template <class Named>
    void line(const char* what, const Named& one, Form form, std::vector<Named> reconstruction::Flap::* list);

    Workbench& bench_;
    CaseRun& run_;
    FlapRun flap_;
    ScenePanel& scene_;
    Form form_;
    std::optional<Form> applied_;  ///< comes back when it is refused
    bool is_draft_ = false;  ///< a form of a new part was closed by something else: it goes on where it was
    bool wants_dialog_ = false, is_drawn_ = false;
};

}  // namespace tactus::window
