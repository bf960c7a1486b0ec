// SPDX-License-Identifier: Apache-2.0
// The layout of the window: all panels.
#pragma once

#include "tools/view/patch/node_panel.hpp"
#include "tools/view/patch/patch_panel.hpp"
#include "tools/view/questions.hpp"
#include "tools/view/scene/calibration_panel.hpp"
#include "tools/view/scene/scene_panel.hpp"
#include "tools/view/signal/scopes.hpp"
#include "tools/view/take_bench.hpp"
#include "tools/view/window.hpp"
#include "tools/view/workbench.hpp"

#include <memory>
#include <set>
#include <string>

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

    /// Dialog when the window closes: end or continue the run?
    enum class Farewell { none, asks, ends, goes_on } farewell = Farewell::none;
    /// Dialogs for unsaved edits: before closing, and when the window opens.
    Questions questions;

private:
    void follow_run();
    /// `height`: of a vertical splitter; a horizontal one fills the width.
    void splitter(const char* id, bool upright, double height, double& share, double whole);
    void panel(const char* id, double width, double height);
    void draw_scene(double height);
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
    std::set<std::string> looked_at_;
    double left_ = 0.64, patch_height_ = 0.58, scene_height_ = 0.55;
};

}  // namespace tactus::view
