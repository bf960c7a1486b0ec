// SPDX-License-Identifier: Apache-2.0
// What the verbs of a plan share: fragments from their files, poses as text and JSON.
#pragma once

#include "assets/plan/case_bones.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/distance/iso_surface.hpp"
#include "tools/study/bones/fragment_file.hpp"

#include <glm/geometric.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus {

/// A fragment ready to be looked at. Its points are never empty.
struct CaseFragment : FragmentBone {
    Voxmap map;
};

/// From its file. Throws Error naming the fragment.
CaseFragment load_fragment(const PlanFragment& fragment, const std::filesystem::path& folder,
                           Paint paint = Paint::as_filed);
/// All of a plan. Throws Error for the first file that is missing or has changed.
std::vector<CaseFragment> load_fragments(const CasePlan& plan, const std::filesystem::path& folder,
                                         Paint paint = Paint::as_filed);

/// Whether a file is read as triangles.
bool is_mesh(const std::filesystem::path& path);
/// The surface in the frame of its file, m: a mesh's own triangles, or that of a bone's distance.
TriangleSurface surface_of_file(const std::filesystem::path& path, const Bone& bone);
/// The points of a mesh's corners, or of a bone. Meshes need not be closed. Throws Error.
std::vector<SurfacePoint> points_of_file(const std::filesystem::path& path);

/// {position_mm, quaternion_wxyz}, in a JSON type.
template <class Json>
Json pose_json(const Pose& pose) {
    const PoseNumbers numbers = numbers_of(pose);
    return {{"position_mm", numbers.position_mm}, {"quaternion_wxyz", numbers.quaternion_wxyz}};
}
/// "X,Y,Z,QW,QX,QY,QZ" in mm. Throws Error naming the option.
Pose pose_of_text(const std::string& text, std::string_view option);

/// What people are told of a fit that repeats the scan (dsp/planning/as_scanned.hpp).
inline constexpr std::string_view as_scanned_note =
    "they touch like that in the scan already: a border between two labels fits itself wherever the fragments lie, and "
    "says nothing of where they belong; compare with the healthy side ('tactus plan mirror')";

/// To two decimals, without the sign of a zero.
double shown_mm(double millimetres);

/// Distance and angle of a pose from none, for people: mm and degrees.
double angle_deg(const Pose& pose);

/// Middle of the points, m.
Vec3 middle_of(std::span<const SurfacePoint> points);
/// Motion of the points' middle between two poses, mm and degrees, in a JSON type.
template <class Json>
Json motion_json(const Pose& from, const Pose& to, std::span<const SurfacePoint> points) {
    const Vec3 middle = middle_of(points);
    return {{"distance_mm", 1e3 * glm::length(to.apply(middle) - from.apply(middle))},
            {"angle_deg", angle_deg(to * from.inverse())}};
}

/// A plan that is being changed: nobody else changes it meanwhile.
struct OpenPlan {
    PlanLock lock;
    CasePlan plan;

    explicit OpenPlan(const std::filesystem::path& path) : lock(path), plan(load_case_plan(path)) {}
};

/// Adds a step with the time of day and saves the plan.
void do_step(CasePlan& plan, PlanStep step, const std::filesystem::path& path);

}  // namespace tactus
