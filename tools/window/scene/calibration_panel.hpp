// SPDX-License-Identifier: Apache-2.0
// Calibrates a display during a run: with the device that the patch has open. The scene is then drawn with the new display
// file.
#pragma once

#include "tools/analysis/display/calibration.hpp"
#include "tools/analysis/display/touch_lead.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/scene/mark_screen.hpp"
#include "tools/window/scene/scene_panel.hpp"
#include "tools/window/scene/touch_watch.hpp"

#include <memory>
#include <optional>
#include <set>
#include <string>

namespace tactus::window {

using analysis::CalibrationSettings;
using analysis::TouchLead;

class CalibrationPanel {
public:
    CalibrationPanel(Workbench& bench, ScenePanel& scene) : bench_(bench), scene_(scene) {}

    bool is_open = false;

    /// Draws the panel as a floating window while open. `feed`: of the run; null: none.
    void draw(const Feed* feed);
    /// Outputs to trace with every value.
    void add_traced(std::set<std::string>& ports) const;

private:
    void choose(const Feed& feed);
    void choose_source(const Feed& feed);
    void begin();
    void lead_on(const Feed& feed);
    void finish();
    void write();
    void write_elsewhere();
    void choose_file();
    void show_fit() const;
    void show_mark();

    Workbench& bench_;
    ScenePanel& scene_;
    CalibrationSettings choice_;
    std::string file_ = "display.toml", screen_, image_, places_;
    TouchSource source_;
    int marks_on_ = -1;  ///< monitor from 1, 0: a window, −1: nowhere
    display::DisplayFile base_;
    display::DisplayFitOptions options_;
    std::optional<TouchLead> lead_;
    std::optional<TouchWatch> watch_;
    std::optional<display::DisplayFit> fit_;  ///< fit of the parts so far
    bool is_unwritten_ = false;  ///< all touches are made, but the file could not be written
    std::unique_ptr<MarkScreen> marks_;
    std::string said_, problem_;  ///< result of the last touch; why the calibration ended
};

}  // namespace tactus::window
