// SPDX-License-Identifier: Apache-2.0
// Converts the values of an observer into meshes on the graphics card and their poses.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/render/made_body.hpp"
#include "tools/render/scene_outline.hpp"
#include "tools/render/section_grey.hpp"

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

namespace tactus::reconstruction {
struct Reconstruction;
}
namespace tactus::plan {
struct CasePlan;
}

namespace tactus::render {

/// Vessels of a plan as tubes, made beside the pictures.
struct VesselTubes {
    struct Part {
        geometry::SurfacePatch patch;
        int place = -1;  ///< in the scene of the body that it rides on; -1: it lies where it was scanned
    };
    struct Vessel {
        std::string name;
        Vec3 colour{0.0};
        bool is_rope = false;  ///< a rope of the patch stands for it
        std::vector<Part> parts;
    };
    std::vector<Vessel> all;
    std::string problem;  ///< why some are missing
};

/// Of a bone that is not carved, by brick.
struct StillSurface {
    geometry::SurfaceGrid grid;
    std::vector<geometry::SurfacePatch> bricks;
    std::string problem;  ///< why it is missing
};

/// Belongs to one renderer. Its context must be current in `update` and in the destructor.
class SceneModel {
public:
    /// Observes the outputs of the outline. Both arguments must outlive the model.
    SceneModel(SceneOutline outline, observe::Observer& observer, display::SceneRenderer& renderer);
    ~SceneModel();
    SceneModel(const SceneModel&) = delete;
    SceneModel& operator=(const SceneModel&) = delete;

    /// From now on a large mesh that is new delays no picture: those of bodies and files are made beside the pictures,
    /// one after another, and those of bones over several pictures. What is not made yet is not drawn.
    void spread_work() { is_spread_ = true; }

    /// Changes to the plan after an edit. Meshes of unchanged nodes are kept.
    void follow(SceneOutline outline);

    /// Takes the values up to the observer's last `advance`: remeshes changed bricks and updates poses. The result is
    /// valid until the next call; a clip plane set in it is kept.
    display::Picture& update();

    const SceneOutline& outline() const { return outline_; }

    /// A bone or body of the last picture, also when it is hidden.
    struct Part {
        std::string name;
        Vec3 colour{0.0};
        bool is_shown = true;
        int place = -1;  ///< of a body in its scene; -1: it is none
        bool is_out_of_plan = false;  ///< the plan hides it: it has no picture, whatever is_shown says
        bool is_locked = false, is_held = false;
        int unit = -1;  ///< bodies of one unit move together; -1: none
        int fits = -1;  ///< place of the body that it was fitted to; -1: none
    };
    const std::vector<Part>& parts() const { return parts_; }
    /// What was chosen for the parts, by their names.
    struct Look {
        std::unordered_set<std::string> hidden;
        std::vector<std::string> chosen;
        std::map<std::string, Vec3> colours;
    };
    const Look& look() const { return look_; }
    /// That of an earlier model of the same patch.
    void use_look(Look look) { look_ = std::move(look); }
    /// Hides a part by name, or shows it, from the next picture on.
    void show_part(const std::string& name, bool wanted);
    /// Gives a body a colour of its own, sRGB, from the next picture on.
    void colour_part(const std::string& name, const Vec3& colour);
    /// Colours the bodies that a map has, from the next picture on; null: none. `range`: m, distance of the fullest
    /// colour.
    void use_map(std::shared_ptr<const SurfaceMap> map, double range);
    /// Draws the fragments of the plan a second time from the next picture on, see-through and in another colour, where
    /// these poses of their files differ from those of the scene; empty: no longer. `name`: for the legend.
    void compare(std::vector<std::optional<Pose>> poses, const std::string& name);
    /// Poses of the files of the plan's fragments, by place, that are drawn from the next picture on in place of those of
    /// the scene; empty: none. For what a person moves and is no step yet.
    void use_poses(std::vector<std::optional<Pose>> poses) { moved_ = std::move(poses); }
    /// The plan of the scene as it is now: from the next picture on its vessels, plates, implants and sites are drawn in
    /// place of those of the file with which the scene began. `file`: the plan's, now; `written`: when.
    void use_plan(const std::filesystem::path& file, const plan::CasePlan& plan,
                  std::filesystem::file_time_type written);
    /// A name at a place of the scene, m.
    struct Label {
        std::string text;
        Vec3 at{0.0}, colour{0.0};
    };
    /// Of the sites in the last picture.
    const std::vector<Label>& labels() const { return labels_; }
    /// The plates with their screws, the implants and the sites that are drawn from the next picture on, in the frame of the case;
    /// at first those of the plan's file. Null: none.
    /// `folder`: of the plan, for the meshes of its guides.
    void use_hardware(std::shared_ptr<const reconstruction::Reconstruction> of,
                      const std::filesystem::path& folder = {});
    /// Whether sections show the density of what is cut, from the next picture on. Files are read beside the pictures, and
    /// sections are flat until then; `waits`: pictures wait for them, and for the vessels of a flap, which are computed
    /// beside the pictures, too.
    void show_density(bool wanted, bool waits = false);
    bool is_reading_density() const;
    /// Of the scene of a plan, in the plan's order; null where one was not drawn yet.
    std::vector<std::shared_ptr<const observe::SeenBody>> plan_bodies() const;
    /// Poses of its fragments' files in that scene, as they are seen; none where one is hidden, or was not drawn yet.
    std::vector<std::optional<Pose>> plan_poses() const;
    /// A fragment of the plan in the last picture: its surface and where it is drawn, in the frame of the case.
    struct PlanPiece {
        std::shared_ptr<const observe::SeenBody> body;
        Vec3 colour{0.0};
        Pose pose;
        bool is_chosen = false;
    };
    /// By place; those that are hidden are missing.
    const std::map<std::size_t, PlanPiece>& plan_pieces() const { return pieces_; }
    /// Parts that are marked, in the order in which they were chosen.
    const std::vector<std::string>& chosen_parts() const { return look_.chosen; }
    /// Marks a part, or no longer if it was the only one; `adds`: the others stay as they are. Empty: none.
    void choose_part(const std::string& name, bool adds = false);
    /// The part that mesh `index` of the last picture belongs to; empty: none.
    std::string part_of(std::size_t index) const;

    /// The colours, the current forces and depths, and what could not be drawn.
    const display::Legend& legend() const { return legend_; }
    /// Bounds of static bodies and of the initial tool poses, for fitting the camera.
    const display::Bounds& bounds() const { return bounds_; }
    /// False while something of the outline has not been seen yet, for some pictures at most: bounds still grow.
    bool is_fitted() const { return !is_fitting_; }
    /// A place on the hand's side of a blade or a ball on a hand, in the last picture.
    const std::optional<Vec3>& tool() const { return tool_; }
    /// Whether mesh `index` of the last picture is a bone that is carved.
    bool is_bone(std::size_t index) const;
    /// Bricks remeshed by the last `update`, and triangles in all.
    std::size_t remeshed_bricks() const { return remeshed_; }
    std::size_t triangles() const;

private:
    struct BoneMesh {
        display::MeshPool::Mesh mesh = -1;
        std::weak_ptr<const observe::SeenBone> of;
        std::uint64_t update = 0;
        display::Bounds bounds;
        int scan = -1;
        std::set<std::uint32_t> left;  ///< bricks to be meshed
        std::size_t bricks = 0;  ///< of the first mesh
        bool is_whole = false;  ///< every brick was meshed once
        DensityCopy density = {};
        analysis::Beside<display::GreyImage> greying = {};
    };
    struct BodyMesh {
        Vec3 colour{0.0};
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        std::shared_ptr<const observe::SeenBody> body;
        contact::Voxmap field;
        bool has_paint = false;
        int map = 0;  ///< number of the map whose colours it has
        int scan = -1;  ///< of the pool
        bool has_scan = false;  ///< it was looked for
    };

    display::MeshPool::Mesh shape_mesh(const std::string& name, const geometry::SurfacePatch& patch);
    std::optional<Pose> pose_of(const std::string& port);
    double number_of(const std::string& port, double otherwise) const;
    void show(display::MeshPool::Mesh mesh, const Pose& pose, const display::Bounds& local, double opacity = 1.0,
              bool is_clipped = true, bool is_fitted = true);
    void show_bones();
    void show_still_bones();
    void show_bodies();
    void show_targets();
    void show_compared();
    void show_hardware();
    bool is_chosen(const std::string& name) const;
    bool is_part_shown(const std::string& name, const Vec3& colour);
    void take_names();
    std::string name_of_body(const SceneOutline::Bodies& scene, std::size_t place) const;
    Vec3 colour_of_body(const std::string& name, const SceneOutline::Bodies& scene, std::size_t place) const;
    struct TaskMesh {
        struct Spared {
            std::string name;
            display::MeshPool::Mesh mesh = -1;
            display::Bounds bounds;
        };
        display::MeshPool::Mesh cut = -1;
        display::Bounds cut_bounds;
        std::vector<Spared> spared;
        std::string problem;  ///< why it is missing
    };
    void show_guides();
    void show_ropes();
    struct MeshOfVessel {
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        int place = -1;  ///< in the scene of the body that it rides on; -1: it lies where it was scanned
    };
    struct PlanVessel {
        std::string name;
        Vec3 colour{0.0};
        bool is_rope = false;
        std::vector<MeshOfVessel> parts;
    };
    struct PlanVessels {
        std::vector<PlanVessel> all;
        std::string problem;  ///< why some are missing
        std::string of;  ///< what they were made of
        analysis::Beside<VesselTubes> making;
    };
    void put_vessels(PlanVessels& to, const VesselTubes& tubes);
    /// `name`: of the plan in the outline; `file`: where it is now.
    void take_vessels(const std::string& name, const std::filesystem::path& file, const plan::CasePlan& plan);
    void remove(const PlanVessels& vessels);
    void forget_vessels();
    void show_vessels();
    void show_tasks();
    TaskMesh make_task(const std::string& path);
    void remove(const TaskMesh& task);
    void show_blades();
    void show_balls();
    void show_gripper();
    void show_force(const std::string& wrench, const Vec3& at, double ahead = 0.0);
    void show_penetration(const BodyMesh& held, const Pose& pose, std::size_t place, const observe::SeenScene& scene);
    void mark(const display::Bounds& bounds, const Pose& pose);
    /// The densities of a file: those of its bone, or of a plan's fragments in their order; empty: being read, or none.
    std::span<const display::GreyImage> densities_of(const std::string& path);
    /// Makes at most one in a picture of a window.
    bool make_scan(int& scan, const display::GreyImage& image);
    void find_scan(BoneMesh& bone, const observe::SeenBone& seen);
    void find_scan(BodyMesh& mesh, const SceneOutline::Bodies& scene, std::size_t place);
    void show_scan(int scan, const Pose& to_scan);
    void take_body(const MadeBody& made);
    void do_not_make(std::uint64_t content, const std::string& why);
    bool has_time(std::chrono::milliseconds more = {}) const {
        return !is_spread_ || std::chrono::steady_clock::now() < until_ + more;
    }
    BodyMesh* mesh_of(std::uint64_t content, const Vec3& colour);

    SceneOutline outline_;
    observe::Observer& observer_;
    display::SceneRenderer& renderer_;
    geometry::BrickSurface mesher_;
    geometry::SurfacePatch patch_, notes_, shown_notes_;
    std::map<std::string, BoneMesh> bones_;
    struct StillMesh {
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        std::string problem;  ///< why it is missing
        int scan = -1;
        analysis::Beside<StillSurface> making;
        StillSurface made;  ///< empty again when the mesh is complete
        bool is_made = false;
        std::size_t taken = 0;  ///< of its bricks
        bool is_whole = false;
    };
    void take_still(StillMesh& bone);
    std::map<std::string, StillMesh> still_bones_;  // by path
    std::map<std::string, TaskMesh> tasks_;  // by path
    struct RopeMesh {
        display::MeshPool::Mesh mesh = -1;
        std::uint64_t content = 0;  // hash of the shape that it shows
        display::Bounds bounds;
    };
    std::map<std::string, RopeMesh> ropes_;  // by port
    std::map<std::string, PlanVessels> vessels_;  // by the plan's file
    std::map<std::uint64_t, BodyMesh> bodies_;
    bool is_spread_ = false;
    std::chrono::steady_clock::time_point until_{};  ///< of work that the next picture may continue
    analysis::Beside<MadeBody> making_;
    std::uint64_t made_body_ = 0;  ///< content of the body that `making_` makes
    std::map<std::uint64_t, std::string> unmade_;  ///< bodies that cannot be made, by content: why
    struct Densities {
        analysis::Beside<std::vector<display::GreyImage>> reading;
        std::vector<display::GreyImage> images;
        bool is_read = false;
    };
    std::map<std::string, Densities> densities_;  // by path
    std::vector<std::optional<Pose>> compared_;
    std::string compared_name_;
    std::vector<std::optional<Pose>> moved_;
    std::map<std::size_t, PlanPiece> pieces_;
    std::map<std::size_t, std::uint64_t> content_at_;  // of the plan's scene: what was seen last, by place
    bool has_made_scan_ = false, is_making_scan_ = false;  ///< in the last picture; some are still to be made
    bool has_density_ = false, waits_for_files_ = false, shows_grey_ = false;
    std::shared_ptr<const SurfaceMap> map_;
    double map_range_ = 1e-3;
    int map_number_ = 0;
    struct HardwareMesh {
        std::string name;
        Vec3 colour{0.0};
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        std::string label = {};  ///< at its middle; empty: none
    };
    std::vector<HardwareMesh> hardware_;
    std::vector<Label> labels_;
    std::optional<std::filesystem::file_time_type> plan_written_;
    std::shared_ptr<const reconstruction::Reconstruction> hardware_of_;
    std::map<std::string, display::MeshPool::Mesh> shapes_;
    std::unordered_set<std::uint64_t> shown_;  // content hashes of the bodies in the last picture
    display::MeshPool::Mesh notes_mesh_;
    std::vector<Part> parts_;
    Look look_;
    struct NamedBody {
        std::string name;
        std::optional<Vec3> colour;
    };
    std::map<std::string, std::vector<NamedBody>> named_;  // by the plan's file
    std::vector<std::pair<std::size_t, std::string>> part_of_mesh_;  // index in picture_.meshes
    display::Picture picture_;
    display::Legend legend_;
    display::Bounds bounds_;
    double deepest_ = 0.0;
    std::optional<Vec3> tool_;
    std::size_t remeshed_ = 0;
    bool is_fitting_ = true;
    std::size_t fragment_count_ = 0;  ///< of a plan, that were seen
    bool is_making_ = false;  ///< a mesh is not complete
    bool is_waiting_ = false;  ///< something that the outline names was not seen
    int waits_ = 0;  ///< pictures since the outline changed
    bool is_guide_shown_ = true;  // of the node whose guides are being drawn
};

}  // namespace tactus::render
