// SPDX-License-Identifier: Apache-2.0
// Measures and changes the reconstruction in a plan, with its surfaces.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/reconstruction/flap_obstacle.hpp"
#include "dsp/reconstruction/ranking.hpp"
#include "dsp/reconstruction/reach.hpp"
#include "dsp/rope/bone_field.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Bone as an obstacle for paths of vessels: distances in their own frame.
struct BoneAsObstacle {
    contact::Voxmap map;
    rope::BoneField field;

    explicit BoneAsObstacle(contact::Voxmap made, const Pose& pose = {}) : map(std::move(made)), field(map, pose) {}
    BoneAsObstacle(const BoneAsObstacle&) = delete;
    BoneAsObstacle& operator=(const BoneAsObstacle&) = delete;
};

/// Loads the meshes that the plan names. Measurements use the current poses of the segments in the plan, or the planned
/// ones if one of them still lies in the leg; candidates use the poses of the inputs.
class FlapStudy {
public:
    /// `folder`: of the plan. Throws Error if the plan's state has no reconstruction, and for files that are missing,
    /// have changed or are not meshes.
    FlapStudy(const plan::CasePlan& plan, const plan::PlanState& state, const std::filesystem::path& folder);
    /// Of inputs with surfaces, without files: no segment is placed, and there are no vessels or plates.
    explicit FlapStudy(reconstruction::FibulaInputs inputs);

    const reconstruction::FibulaInputs& inputs() const { return inputs_; }  ///< with surfaces
    const reconstruction::FibulaPlan& fibula() const { return fibula_; }
    const reconstruction::Flap& flap() const { return all_.flap; }
    const reconstruction::Reconstruction& reconstruction() const { return all_; }
    const std::vector<Vec3>& tumour() const { return tumour_; }
    /// Fragment and pose of each segment in the plan; empty if the plan does not have all segments.
    struct SegmentPlace {
        int fragment = 0;
        Pose pose;
        bool is_placed = false;  ///< false: it lies in the leg, as scanned
    };
    const std::vector<SegmentPlace>& segments() const { return segments_; }

    /// Files of the bones of the plan that are shown, with their poses: the jaw, then the segments that are placed.
    std::vector<std::pair<std::filesystem::path, Pose>> placed_files() const;
    /// The segments where measures hold.
    reconstruction::FibulaPlan placed_plan() const;
    /// The bone of jaw and segments, frame of the jaw. It must not outlive this object.
    reconstruction::FlapObstacle bone();

    reconstruction::FlapMeasures measures();
    std::vector<reconstruction::Candidate> candidates();

private:
    void make_obstacles();
    bool needs_obstacles() const;

    reconstruction::Reconstruction all_;
    reconstruction::FibulaInputs inputs_;
    reconstruction::FibulaPlan fibula_;
    std::vector<SegmentPlace> segments_;
    std::vector<std::pair<std::filesystem::path, Pose>> jaw_files_, segment_files_;
    std::filesystem::path donor_file_;
    std::vector<Vec3> tumour_;
    std::unique_ptr<BoneAsObstacle> donor_;
    std::vector<std::unique_ptr<BoneAsObstacle>> jaw_;
};

/// Reads the surface of a piece of jaw or donor from a mesh or a bone file: m, in the frame of its file. Throws Error.
geometry::TriangleSurface surface_of_piece(const std::filesystem::path& file);

/// Returns whether a fragment has the name of a segment, "segment-2" or "segment-2-ALTERNATIVE".
bool is_segment(const std::string& name);

/// Loads a plan, applies `change` to its reconstruction and adds the result as a step. Throws Error if there is no
/// reconstruction or the result is invalid, and rethrows errors of `change`; then the plan is unchanged.
void change_reconstruction(const std::filesystem::path& plan,
                           const std::function<void(reconstruction::Reconstruction&, const plan::CasePlan&)>& change);

/// Returns a mesh file as a plan refers to it.
reconstruction::MeshFile mesh_file(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace tactus::analysis
