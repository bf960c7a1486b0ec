// SPDX-License-Identifier: Apache-2.0
// The layout of the window: all panels.
#pragma once

#include "tools/view/frame/layout.hpp"
#include "tools/view/patch/node_panel.hpp"
#include "tools/view/patch/patch_panel.hpp"
#include "tools/view/plan/plan_panel.hpp"
#include "tools/view/questions.hpp"
#include "tools/view/scene/calibration_panel.hpp"
#include "tools/view/scene/scene_panel.hpp"
#include "tools/view/signal/scopes.hpp"
#include "tools/view/take_bench.hpp"
#include "tools/view/train/train_panel.hpp"
#include "tools/view/window.hpp"
#include "tools/view/workbench.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tactus::view {

class Desk {
public:
    Desk(Window& window, Workbench& bench, TakeBench* take);

    /// Draws one frame, between Window::begin and Window::end.
    void draw();

    Workbench& bench() { return bench_; }
    TakeBench* take() { return take_; }
    PatchPanel& patch() { return patch_; }
    const PatchPanel& patch() const { return patch_; }
    NodePanel& nodes() { return nodes_; }
    Scopes& scopes() { return scopes_; }
    ScenePanel& scene() { return scene_; }
    const Feed* feed() const;

    Layout layout = Layout::patch;

    /// Dialog when the window closes: end or continue the run?
    enum class Farewell { none, asks, ends, goes_on } farewell = Farewell::none;
    /// Dialogs for unsaved edits: before closing, and when the window opens.
    Questions questions;

private:
    void follow_run();
    /// `height`: of a vertical splitter; a horizontal one fills the width. Returns how far it is moved, pixels.
    double splitter(const std::string& id, bool upright, double height);
    /// Whether a panel has something to show.
    PanelRoom room_of(Panel panel);
    /// Columns for the panels there are, with the borders where a person has put them.
    void arrange(double width);
    void draw_column(std::size_t index, double height);
    void draw_panel(Panel panel, double height);
    void draw_patch(double height);
    void draw_scopes(double height);
    void draw_scene(double height);
    void draw_node(double height);
    void draw_tree(double height);
    void draw_steps(double height);
    void draw_task(double height);
    void show_messages(double height);
    void ask_farewell();
    void shortcuts();

    Window& window_;
    Workbench& bench_;
    TakeBench* take_;
    std::unique_ptr<LiveFeed> live_;
    int runs_ = 0;
    Fonts fonts_;
    PatchPanel patch_;
    NodePanel nodes_;
    Scopes scopes_;
    ScenePanel scene_;
    CalibrationPanel calibration_;
    PlanPanel plan_;
    TrainPanel train_;
    std::set<std::string> looked_at_;
    std::vector<LayoutColumn> columns_;
    std::vector<std::vector<LayoutColumn>> moved_;  ///< columns of other layouts and panels, for when they return
};

}  // namespace tactus::view
