// SPDX-License-Identifier: Apache-2.0
// The scene in space: bones, bodies, tools and forces, viewed from any side or through the screens of a display, with
// clipping and measuring.
#pragma once

#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/render/markups.hpp"
#include "tools/render/scene_model.hpp"
#include "tools/render/sight.hpp"
#include "tools/window/document/fragment_mover.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/frame/commands.hpp"
#include "tools/window/hand/pulled_hands.hpp"
#include "tools/window/hand/scene_hand.hpp"
#include "tools/window/scene/scene_motion.hpp"
#include "tools/window/scene/scene_screens.hpp"
#include "tools/window/widgets/painter.hpp"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

using render::SceneModel;
using render::Sight;
using render::SightChoice;

class ScenePanel {
public:
    explicit ScenePanel(Workbench& bench) : bench_(bench) {}
    /// Writes kept measurements that are in no file yet, and says where on standard error.
    ~ScenePanel();
    ScenePanel(const ScenePanel&) = delete;
    ScenePanel& operator=(const ScenePanel&) = delete;

    /// `observer` may be null; a different one means a new run.
    void draw(const std::shared_ptr<observe::Observer>& observer, const Fonts& fonts);

    /// Replaces `draw` while the patch has no scene: closes the windows and releases the run.
    void rest();

    /// Lets the mouse drag the chosen fragments of a plan; it must outlive the panel. Null: it does not.
    void use_mover(FragmentMover* mover) { mover_ = mover; }

    /// The bones and bodies as a list.
    void draw_tree();
    /// What can be done to it, by name.
    void add_commands(std::vector<Command>& all);

    /// The hand that the mouse moves, in runs with the driver 'mouse'.
    SceneHand& hand() { return hand_; }

    /// True when the patch has nothing to draw: no bone, body, tool or pose.
    bool is_empty();

    display::OrbitCamera camera;
    void look_from(display::NamedView view);
    void fit() { is_aimed_ = false; }
    /// Resets the view: iso, all visible, no clipping, no measurement.
    void reset();
    /// Clips the scene above a fraction of its extent along an axis; axis −1: no clipping; 3: along the line of sight as
    /// it is now; 4: along the normal of the plane through three measured points, at first through these.
    void clip(int axis, double share);
    /// Clips the scene along the plane through three measured points.
    void clip_through_marks();
    /// Number of pictures drawn, each step of one that is drawn in steps; a scene that does not change is not drawn again.
    std::int64_t pictures() const { return pictures_; }
    /// The parts of the last picture.
    std::span<const SceneModel::Part> parts() const;
    /// The points that are measured now, m.
    std::span<const Vec3> marks() const { return marks_; }
    /// Places in their scene of the chosen bodies, in the order in which they were chosen.
    std::vector<int> chosen_places() const;
    /// Colours the fragments of a plan; null: by their own colours. `range`: m, distance of the fullest colour.
    void use_map(std::shared_ptr<const render::SurfaceMap> map, double range);
    void set_map_range(double range);
    /// Of the plan in the scene, in its order; empty: not seen yet.
    std::vector<std::shared_ptr<const observe::SeenBody>> plan_bodies() const;
    /// Whether everything that the patch has in space was drawn.
    bool is_fitted() const { return model_ && model_->is_fitted(); }
    /// The fragments of a plan as they are drawn; empty: none was drawn yet.
    const std::map<std::size_t, SceneModel::PlanPiece>& plan_pieces() const;
    /// File of the plan in the scene, as the run began; empty: none.
    std::string plan_file() const;
    /// Draws vessels, plates, implants and sites of the plan as it is now; see SceneModel.
    void use_plan(const std::filesystem::path& file, const plan::CasePlan& plan, std::int64_t version);
    /// Draws the fragments of a plan a second time, at these poses of their files and in another colour; empty: no longer.
    void compare(std::vector<std::optional<Pose>> poses, const std::string& name);
    /// A place that slices share, m; a click on a surface moves it. None: there are no slices.
    std::optional<Vec3> cursor;
    bool is_measuring = false;
    bool is_siting = false;  ///< the next click on a bone moves the saw there
    bool has_few_tools = false;  ///< above the picture: views and the hand, as a trainee needs them
    bool wants_calibration = false;  ///< requests the calibration panel
    /// Where measurements go; empty: to the folder of the run.
    std::filesystem::path folder_of_results;

    // View settings. All throw Error and then change nothing.
    void use(const SightChoice& choice);
    /// A stereo mode by name or number.
    void use_stereo(const std::string& mode);
    void use_head(const std::string& port);
    void use_display(const std::string& file);
    const std::optional<display::DisplayFile>& display_file() const { return sight_.display_file(); }
    void use_offset(const std::string& offset);
    /// Opens or closes separate windows for the screens.
    void show_screens(bool wanted);

private:
    void tools();
    void sight_tools();
    void steer(Point corner, int width, int height);
    void steer_by_keys(bool is_pointed_at);
    /// Drags a chosen fragment. True: the mouse is the fragment's.
    bool steer_fragment(Point corner, int height);
    void press_fragment(Point corner);
    void take_fragment();
    void drag_fragment(int height);
    void follow_mover();
    void draw_handles(const Painter& paint, Point corner, double pixel);
    void render(int width, int height);
    void draw_step(display::Picture& picture);
    void service_screens();
    void watch_sight();
    display::Legend legend() const;
    void measure(Point pixel);
    void move_site(Point pixel);
    void choose(Point pixel);
    void lead_hand(Point pixel);
    void keep_measurement();
    void save_measurements();
    /// Throws Error when there is no folder for it. Returns the file.
    std::filesystem::path write_measurements();
    void forget_model();
    void draw_measurements();
    std::optional<display::Plane> clip_plane() const;
    std::optional<display::Picked> pick(Point pixel);
    /// Where a place of the scene is seen in a view of a tile.
    static std::optional<Point> place_in(const SceneScreens::Tile& tile, const display::DrawnView& view,
                                         const Vec3& in_scene, Point corner, double pixel);
    void draw_cursor(const Painter& paint, Point corner, double pixel);
    void draw_measured(const render::Measurement& measured, ImU32 colour, const Painter& paint, Point corner,
                       double pixel);
    void draw_labels(const Painter& paint, Point corner, double pixel);
    void draw_hand(const Painter& paint, Point corner, Point size, double pixel);
    void draw_legend(const Painter& paint, Point corner, int height, double scale);
    void attempt(const std::function<void()>& what);

    Workbench& bench_;
    std::shared_ptr<observe::Observer> observer_;
    std::unique_ptr<display::SceneRenderer> renderer_;
    std::unique_ptr<SceneModel> model_;
    std::shared_ptr<const render::SurfaceMap> map_;
    double map_range_ = 1e-3;
    std::vector<std::optional<Pose>> compared_;
    std::string compared_name_;
    Sight sight_{SightChoice{}};
    SceneScreens screens_;
    SceneMotion motion_;
    MotionGrain grain_;
    SceneHand hand_;
    PulledHands pulled_;
    FragmentMover* mover_ = nullptr;
    std::int64_t moves_shown_ = -1;  ///< version of the mover
    enum class Grip { none, plane, shift, turn };
    /// A line of the handles on the screen, which the mouse can drag.
    struct Handle {
        Grip grip = Grip::none;
        int axis = 0;
        std::vector<Point> line;
    };
    std::vector<Handle> handles_;  ///< as they were drawn last
    Point handles_at_;
    Grip grip_ = Grip::none;  ///< of the fragment that is pressed
    int grip_axis_ = 0, gripped_ = -1;
    std::optional<Vec3> grip_at_;  ///< none: the middle of the fragment
    enum class Hold { pressed, drags, ended } hold_ = Hold::pressed;
    std::string waits_for_;  ///< why a pressed fragment does not follow the pointer yet
    Point dragged_;  ///< since the press, pixels: what the fragment has followed
    enum class Windows { as_they_are, as_display_file, all, none } windows_ = Windows::as_they_are;
    std::vector<std::string> watched_;  ///< ports
    std::int64_t plan_version_ = -1, judged_version_ = -1;
    bool is_empty_ = true;
    bool is_aimed_ = false, needs_picture_ = true;
    display::OrbitCamera fitted_;  ///< as the last fit left the camera
    bool was_drawn_ = false;
    double looked_at_ = -1.0, cost_s_ = 0.0;  ///< cost: time per picture, including the window
    std::int64_t pictures_ = 0;
    int width_ = 0, height_ = 0;  ///< size of the last picture, pixels
    int clip_axis_ = -1;  ///< 3: across the view as it was; 4: through the measured points
    Vec3 clip_normal_{0.0, 0.0, 1.0};
    double clip_share_ = 0.5;
    std::string display_file_, offset_ = "as the display file says";
    std::vector<Vec3> marks_;
    std::vector<render::Measurement> measurements_;
    bool has_unwritten_ = false;  ///< of the measurements
    SceneModel::Look look_;  ///< for the next model
    render::SceneOutline aimed_at_;
    double sited_at_ = -10.0;  ///< when a click has moved the saw; its second click is none for the hand
    std::string problem_, note_;  ///< note: why a screen is not shown as requested
};

}  // namespace tactus::window
