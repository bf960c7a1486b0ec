// SPDX-License-Identifier: Apache-2.0
// The scene in space: bones, bodies, tools and forces, looked at from any side or through the screens of a rig, cut open
// and measured.
#pragma once

#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/picture/scene/scene_model.hpp"
#include "tools/picture/scene/sight.hpp"
#include "tools/view/painter.hpp"
#include "tools/view/scene/scene_motion.hpp"
#include "tools/view/scene/scene_screens.hpp"
#include "tools/view/workbench.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::view {

using picture::SceneModel;
using picture::Sight;
using picture::SightChoice;

class ScenePanel {
public:
    explicit ScenePanel(Workbench& bench) : bench_(bench) {}

    /// `observer` may be null; another one is another run.
    void draw(const std::shared_ptr<observe::Observer>& observer, const Fonts& fonts);

    /// In place of `draw` while the patch is empty: windows close until something is there again, and the run is let go.
    void rest();

    /// The patch has nothing in space: no bone, body, tool or pose.
    bool is_empty();

    display::OrbitCamera camera;
    void look_from(display::NamedView view);
    void fit() { is_aimed_ = false; }
    /// As it was in the beginning: from iso, all of it, nothing cut away, nothing measured.
    void reset();
    /// Cuts away what lies above a share of the scene's extent along an axis; axis −1: nothing.
    void clip(int axis, double share);
    bool is_measuring = false;
    bool wants_calibration = false;  ///< asked for, for whoever leads through it

    // How it is looked at. All throw Error, and nothing has changed then.
    void use(const SightChoice& choice);
    /// "side-by-side" and so on, or its number from 0.
    void use_stereo(const std::string& mode);
    void use_head(const std::string& port);
    void use_rig(const std::string& file);
    const std::optional<display::RigFile>& rig() const { return sight_.rig(); }
    void use_offset(const std::string& offset);
    /// Windows of their own for the screens.
    void show_screens(bool wanted);

private:
    void tools();
    void sight_tools();
    void steer(int width, int height);
    void render(int width, int height);
    void tend_screens();
    void watch_sight();
    display::Legend legend() const;
    void measure(Point pixel);
    void draw_marks(const Painter& paint, Point corner, double pixel);
    void draw_legend(const Painter& paint, Point corner, int height, double scale);
    void attempt(const std::function<void()>& what);

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::unique_ptr<display::SceneRenderer> renderer_;
    std::unique_ptr<SceneModel> model_;
    Sight sight_{SightChoice{}};
    SceneScreens screens_;
    SceneMotion motion_;
    enum class Windows { as_they_are, where_rig_says, all, none } windows_ = Windows::as_they_are;
    std::vector<std::string> watched_;  ///< ports
    std::int64_t plan_version_ = -1, judged_version_ = -1;
    bool is_empty_ = false;
    bool is_aimed_ = false, needs_picture_ = true;
    bool was_drawn_ = false;
    double looked_at_ = -1.0, cost_s_ = 0.0;  ///< cost: of a picture, with the window around it
    int width_ = 0, height_ = 0;  ///< of the last picture, pixels
    int clip_axis_ = -1;
    double clip_share_ = 0.5;
    std::string rig_file_, offset_ = "as the rig says";
    std::vector<Vec3> marks_;
    std::string problem_, note_;  ///< note: why a screen is not shown as it was wanted
};

}  // namespace tactus::view
