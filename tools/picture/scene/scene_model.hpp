// SPDX-License-Identifier: Apache-2.0
// The scene of a run: from what an observer sees to meshes on the graphics card and where they stand.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "engine/observer.hpp"
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
    SceneModel(SceneOutline outline, Observer& observer, SceneRenderer& renderer);
    ~SceneModel();
    SceneModel(const SceneModel&) = delete;
    SceneModel& operator=(const SceneModel&) = delete;

    /// After an edit: draws what the new plan has. Meshes of what goes on stay.
    void follow(SceneOutline outline);

    /// Takes over what the observer saw up to its last `advance`: remeshes the bricks that changed and moves everything
    /// to where it is. What it returns stays valid until the next call; a clip plane set in it stays.
    Picture& update();

    const SceneOutline& outline() const { return outline_; }

    /// The colours of the picture, the forces and depths of this moment, and what could not be drawn.
    const Legend& legend() const { return legend_; }
    /// Of what stands still and of where tools began: what a camera is fitted to.
    const Bounds& bounds() const { return bounds_; }
    /// From where a blade came in the last picture.
    const std::optional<Vec3>& tool() const { return tool_; }
    /// Bricks that the last `update` made anew, and triangles of everything.
    std::size_t remeshed_bricks() const { return remeshed_; }
    std::size_t triangles() const;

private:
    struct BoneMesh {
        MeshPool::Mesh mesh = -1;
        std::weak_ptr<const SeenBone> of;
        std::uint64_t update = 0;
        Bounds bounds;
    };
    struct BodyMesh {
        MeshPool::Mesh mesh = -1;
        Bounds bounds;
        std::shared_ptr<const SeenBody> body;
        Voxmap field;
        bool has_paint = false;
    };

    MeshPool::Mesh shape_mesh(const std::string& name, const SurfacePatch& patch);
    std::optional<Pose> pose_of(const std::string& port);
    double number_of(const std::string& port, double otherwise) const;
    void show(MeshPool::Mesh mesh, const Pose& pose, const Bounds& local, double opacity = 1.0, bool is_clipped = true,
              bool is_fitted = true);
    void show_bones();
    void show_still_bones();
    void show_bodies();
    void show_blades();
    void show_balls();
    void show_gripper();
    void show_force(const std::string& wrench, const Vec3& at);
    void show_penetration(const BodyMesh& held, const Pose& pose, std::size_t place, const SeenScene& scene);
    BodyMesh* mesh_of(std::uint64_t content, std::size_t place);

    SceneOutline outline_;
    Observer& observer_;
    SceneRenderer& renderer_;
    BrickSurface mesher_;
    SurfacePatch patch_, notes_, shown_notes_;
    std::map<std::string, BoneMesh> bones_;
    struct StillMesh {
        MeshPool::Mesh mesh = -1;
        Bounds bounds;
        std::string problem;  ///< why it is not there
    };
    std::map<std::string, StillMesh> still_bones_;  // by path
    std::map<std::uint64_t, BodyMesh> bodies_;
    std::map<std::string, MeshPool::Mesh> shapes_;
    std::unordered_set<std::uint64_t> shown_;  // content of the bodies in the last picture
    MeshPool::Mesh notes_mesh_;
    Picture picture_;
    Legend legend_;
    Bounds bounds_;
    double deepest_ = 0.0;
    std::optional<Vec3> tool_;
    std::size_t remeshed_ = 0;
    bool is_fitting_ = true;
};

}  // namespace tactus::picture
