// SPDX-License-Identifier: Apache-2.0
// The scene in space: bones, bodies, tools and forces, looked at from any side, cut open and measured.
#pragma once

#include "devices/display/scene_renderer.hpp"
#include "engine/observer.hpp"
#include "tools/scene_model.hpp"
#include "tools/view/painter.hpp"
#include "tools/view/texture_target.hpp"
#include "tools/view/workbench.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tactus::view {

class ScenePanel {
public:
    explicit ScenePanel(Workbench& bench) : bench_(bench) {}

    /// `observer` may be null; another one is another run.
    void draw(const std::shared_ptr<Observer>& observer, const Fonts& fonts);
    /// Outputs that the scene needs.
    void add_wanted(std::set<std::string>& ports) const;

    OrbitCamera camera;
    StereoMode stereo = StereoMode::mono;
    void look_from(NamedView view);
    void fit() { is_aimed_ = false; }
    /// Cuts away what lies above a share of the scene's extent along an axis; axis −1: nothing.
    void clip(int axis, double share);
    bool is_measuring = false;

private:
    void tools();
    void steer(int width, int height);
    void render(int width, int height);
    void measure(Point pixel, int height);
    void draw_marks(const Painter& paint, Point corner, int width, int height);
    void draw_legend(const Painter& paint, Point corner, int height, double scale);

    Workbench& bench_;
    std::shared_ptr<Observer> observer_;
    std::unique_ptr<SceneRenderer> renderer_;
    std::unique_ptr<SceneModel> model_;
    TextureTarget target_;
    std::vector<DrawnView> views_;
    std::set<std::string> wanted_;
    std::int64_t plan_version_ = -1;
    bool is_aimed_ = false, needs_picture_ = true;
    bool was_drawn_ = false;
    double drawn_at_ = -1.0, cost_s_ = 0.0;  ///< cost: of the last picture, with the window around it
    int clip_axis_ = -1;
    double clip_share_ = 0.5;
    std::vector<Vec3> marks_;
    std::string problem_;
};

}  // namespace tactus::view
