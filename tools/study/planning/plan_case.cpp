// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_case.hpp"

#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/operator/hand.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/workers.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tactus {

bool is_mesh(const std::filesystem::path& path) {
    const auto extension = path.extension();
    return extension == ".stl" || extension == ".ply" || extension == ".obj";
}

CaseFragment load_fragment(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint) {
    CaseFragment loaded{fragment_bone(fragment, folder, paint, on_threads()), {}};
    loaded.map = make_voxmap(loaded.bone.distance);
    return loaded;
}

std::vector<CaseFragment> load_fragments(const CasePlan& plan, const std::filesystem::path& folder, Paint paint) {
    check_files(plan, folder);
    std::vector<CaseFragment> all;
    for (const PlanFragment& fragment : plan.fragments) all.push_back(load_fragment(fragment, folder, paint));
    return all;
}

TriangleSurface surface_of_file(const std::filesystem::path& path, const Bone& bone) {
    if (is_mesh(path)) return load_mesh(path, 1e-3);
    return export_surface(bone.distance);
}

std::vector<SurfacePoint> points_of_file(const std::filesystem::path& path) {
    if (!is_mesh(path)) {
        const Bone bone = bone_of_file(path);
        return bone.points.empty() ? sample_surface(bone.distance, {}) : bone.points;
    }
    const Mesh mesh = load_mesh(path, 1e-3);
    std::vector<SurfacePoint> points(mesh.vertices.size());
    for (std::size_t n = 0; n < points.size(); ++n) points[n] = {mesh.vertices[n], Vec3(0.0), 0.0, 0};
    for (const auto& t : mesh.triangles) {
        const auto corner = [&](std::size_t c) { return static_cast<std::size_t>(t[c]); };
        const Vec3 across = glm::cross(mesh.vertices[corner(1)] - mesh.vertices[corner(0)],
                                       mesh.vertices[corner(2)] - mesh.vertices[corner(0)]);
        for (std::size_t c = 0; c < 3; ++c) {
            points[corner(c)].normal += across;
            points[corner(c)].area += glm::length(across) / 6.0;
        }
    }
    std::erase_if(points, [](const SurfacePoint& p) { return !(glm::length(p.normal) > 0.0); });
    for (SurfacePoint& p : points) p.normal = glm::normalize(p.normal);
    return points;
}

Pose pose_of_text(const std::string& text, std::string_view option) {
    double v[7];
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf%c", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6,
                    &rest) != 7)
        throw Error(fmt::format("{} takes X,Y,Z,QW,QX,QY,QZ: a place in mm and a unit quaternion", option));
    const Pose pose{1e-3 * Vec3(v[0], v[1], v[2]), Quat(v[3], v[4], v[5], v[6])};
    if (!is_valid(pose)) throw Error(fmt::format("{} needs finite numbers and a quaternion of unit length", option));
    return {pose.position, glm::normalize(pose.orientation)};
}

double shown_mm(double millimetres) { return std::round(millimetres * 100.0) / 100.0 + 0.0; }

double angle_deg(const Pose& pose) {
    return glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, pose.orientation)) * 180.0 / std::numbers::pi;
}

Vec3 middle_of(std::span<const SurfacePoint> points) {
    Vec3 middle(0.0);
    for (const SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    return middle;
}

void do_step(CasePlan& plan, PlanStep step, const std::filesystem::path& path) {
    step.time = time_of_day();
    add_step(plan, std::move(step));
    save_case_plan(plan, path);
}

}  // namespace tactus
