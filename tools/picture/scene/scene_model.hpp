// SPDX-License-Identifier: Apache-2.0
// The scene of a run: from what an observer sees to meshes on the graphics card and where they stand.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/picture/scene/scene_outline.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace tactus::picture {

/// Belongs to one renderer, whose context must be current in `update` and the destructor.
class SceneModel {
public:
    /// Begins to watch what the outline names. Both must outlive the model.
    SceneModel(SceneOutline outline, observe::Observer& observer, display::SceneRenderer& renderer);
    ~SceneModel();
    SceneModel(const SceneModel&) = delete;
    SceneModel& operator=(const SceneModel&) = delete;

    /// After an edit: draws what the new plan has. Meshes of what goes on stay.
    void follow(SceneOutline outline);

    /// Takes over what the observer saw up to its last `advance`: remeshes the bricks that changed and moves everything
    /// to where it is. What it returns stays valid until the next call; a clip plane set in it stays.
    display::Picture& update();

    const SceneOutline& outline() const { return outline_; }

    /// The colours of the picture, the forces and depths of this moment, and what could not be drawn.
    const display::Legend& legend() const { return legend_; }
    /// Of what stands still and of where tools began: what a camera is fitted to.
    const display::Bounds& bounds() const { return bounds_; }
    /// From where a blade came in the last picture.
    const std::optional<Vec3>& tool() const { return tool_; }
    /// Bricks that the last `update` made anew, and triangles of everything.
    std::size_t remeshed_bricks() const { return remeshed_; }
    std::size_t triangles() const;

private:
    struct BoneMesh {
        display::MeshPool::Mesh mesh = -1;
        std::weak_ptr<const observe::SeenBone> of;
        std::uint64_t update = 0;
        display::Bounds bounds;
    };
    struct BodyMesh {
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        std::shared_ptr<const observe::SeenBody> body;
        contact::Voxmap field;
        bool has_paint = false;
    };

    display::MeshPool::Mesh shape_mesh(const std::string& name, const geometry::SurfacePatch& patch);
    std::optional<Pose> pose_of(const std::string& port);
    double number_of(const std::string& port, double otherwise) const;
    void show(display::MeshPool::Mesh mesh, const Pose& pose, const display::Bounds& local, double opacity = 1.0,
              bool is_clipped = true, bool is_fitted = true);
    void show_bones();
    void show_still_bones();
    void show_bodies();
    void show_blades();
    void show_balls();
    void show_gripper();
    void show_force(const std::string& wrench, const Vec3& at);
    void show_penetration(const BodyMesh& held, const Pose& pose, std::size_t place, const observe::SeenScene& scene);
    BodyMesh* mesh_of(std::uint64_t content, std::size_t place);

    SceneOutline outline_;
    observe::Observer& observer_;
    display::SceneRenderer& renderer_;
    geometry::BrickSurface mesher_;
    geometry::SurfacePatch patch_, notes_, shown_notes_;
    std::map<std::string, BoneMesh> bones_;
    struct StillMesh {
        display::MeshPool::Mesh mesh = -1;
        display::Bounds bounds;
        std::string problem;  ///< why it is not there
    };
    std::map<std::string, StillMesh> still_bones_;  // by path
    std::map<std::uint64_t, BodyMesh> bodies_;
    std::map<std::string, display::MeshPool::Mesh> shapes_;
    std::unordered_set<std::uint64_t> shown_;  // content of the bodies in the last picture
    display::MeshPool::Mesh notes_mesh_;
    display::Picture picture_;
    display::Legend legend_;
    display::Bounds bounds_;
    double deepest_ = 0.0;
    std::optional<Vec3> tool_;
    std::size_t remeshed_ = 0;
    bool is_fitting_ = true;
};

}  // namespace tactus::picture
