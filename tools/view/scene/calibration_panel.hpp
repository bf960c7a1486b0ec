// SPDX-License-Identifier: Apache-2.0
// Leads through the calibration of a rig within a run: with the device that the patch has open, into the rig that its scene
// is seen through.
#pragma once

#include "tools/study/displays/calibration.hpp"
#include "tools/study/displays/touch_lead.hpp"
#include "tools/view/scene/mark_screen.hpp"
#include "tools/view/scene/scene_panel.hpp"
#include "tools/view/scene/touch_watch.hpp"
#include "tools/view/workbench.hpp"

#include <memory>
#include <optional>
#include <set>
#include <string>

namespace tactus::view {

using study::CalibrationSettings;
using study::TouchLead;

class CalibrationPanel {
public:
    CalibrationPanel(Workbench& bench, ScenePanel& scene) : bench_(bench), scene_(scene) {}

    bool is_open = false;

    /// A window of its own while it is open. `feed`: of the run; null: none.
    void draw(const Feed* feed);
    /// Outputs whose every value it needs.
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
    std::string file_ = "rig.toml", screen_, image_, places_;
    TouchSource source_;
    int marks_on_ = -1;  ///< monitor from 1, 0: a window, −1: nowhere
    display::RigFile base_;
    display::RigFitOptions options_;
    std::optional<TouchLead> lead_;
    std::optional<TouchWatch> watch_;
    std::optional<display::RigFit> fit_;  ///< of the parts so far
    bool is_unwritten_ = false;  ///< all is touched, and the file could not be written
    std::unique_ptr<MarkScreen> marks_;
    std::string said_, problem_;  ///< of the last touch; why it ended
};

}  // namespace tactus::view
