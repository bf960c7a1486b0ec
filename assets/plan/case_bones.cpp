// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/case_bones.hpp"

#include "assets/bone/import.hpp"
#include "assets/bone/surface_points.hpp"
#include "assets/file/extension.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/plan/kept_points.hpp"
#include "assets/plan/mesh_unit.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "assets/plan/propose_paint.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace tactus::plan {

// A plan has no place for a unit, and fragments may be smaller than whole bones: mm, unless a mesh is far too small or
// too large for that; then import refuses it.
std::optional<std::string> unit_of_file(const std::filesystem::path& path) {
    if (volume::is_volume_file(path)) return "mm";
    mesh::MeshOrigin origin;
    const mesh::Mesh mesh = mesh::load_mesh(path, 1.0, &origin);
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& v : mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (origin.unit || !(extent >= 5.0 && extent <= 2000.0)) return std::nullopt;
    return "mm";
}

bone::Bone bone_from_file(const std::filesystem::path& path, const RunJobs& run, Contents contents) {
    if (file::extension_of(bone::file_of_bone(path)) == ".vdb") return bone::load_bone(path);
    if (!volume::is_volume_file(path)) return bone_of_mesh(path, unit_of_file(path), contents, run);
    bone::ImportOptions options;
    options.input = path;
    options.run = run;
    options.unit = "mm";
    return bone::import_bone(options);
}

namespace {

// To be raised with every change of code that changes the paint that propose_fracture finds.
constexpr int proposed_paint = 1;

bool is_painted(std::span<const contact::SurfacePoint> points) {
    return std::ranges::any_of(
        points, [](const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; });
}

}  // namespace

ResultKey key_of_points(const std::filesystem::path& path) {
    // To be raised with every change of code that changes which points a file gives: import, sampling.
    constexpr int points_sampling = 3;
    ResultKey key("points of a fragment", points_sampling);
    key.add_file(path);
    return key;
}

FragmentBone fragment_bone(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint,
                           const RunJobs& run, Contents contents) {
    FragmentBone loaded;
    try {
        const std::filesystem::path path = file_of(fragment.file, folder);
        loaded.bone = bone_from_file(path, run, contents);
        std::vector<contact::SurfacePoint>& points = loaded.bone.points;
        std::string ignored;  // points that are damaged are made again
        const bool has_points = !points.empty();
        const auto sampled = [&] { return bone::surface_points(loaded.bone, {}, run); };
        points = has_points ? sampled() : points_of_key(key_of_points(path), ignored, sampled);
        if (points.empty()) throw Error("has no surface");
        loaded.was_painted = is_painted(points);
        if (!loaded.was_painted && paint == Paint::or_proposed) {
            ResultKey key("paint proposed on a fragment", proposed_paint);
            key.add_file(path);
            points = points_of_key(key, ignored, [&] {
                propose_fracture(points);
                return points;
            });
        }
    } catch (const Error& error) {
        const bool is_bone = file::extension_of(bone::file_of_bone(fragment.file)) == ".vdb";
        throw Error(fmt::format(
            "fragment '{}': {}{}", fragment.name, error.what(),
            is_bone ? "" : "; convert it with 'tactus import', which has options for that, and use the .vdb"));
    }
    return loaded;
}

void check_files(const CasePlan& plan, const std::filesystem::path& folder) {
    const auto problems = changed_files(plan, folder);
    if (problems.empty()) return;
    const bool is_fragment = problems.front().starts_with("fragment");
    throw Error(fmt::format("{}{}; put the file back, {}or make a plan of the new one", problems.front(),
                            problems.size() > 1 ? fmt::format(" (and {} more)", problems.size() - 1) : "",
                            is_fragment ? "take it when only its paint differs ('tactus plan repaint'), " : ""));
}

CaseBones load_case(const std::filesystem::path& path) {
    CaseBones made;
    made.plan = load_case_plan(path);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    try {
        check_files(made.plan, folder);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.message()));
    }
    for (const PlanFragment& fragment : fragments_of(made.plan))
        made.bones.push_back(fragment_bone(fragment, folder, Paint::or_proposed).bone);
    make_files_absolute(made.plan, folder);
    return made;
}

}  // namespace tactus::plan
