// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/assumed_density.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/bone/mesh_part.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/repair.hpp"
#include "assets/volume/length_unit.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/surface_distance.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace tactus::bone {

namespace {

constexpr double most_mesh_voxels = 4e8;

struct Unit {
    double metres;
    std::string_view from;  // for the provenance
};

Unit unit_of(const ImportOptions& options, const mesh::MeshOrigin& origin, double extent) {
    if (options.unit) return {volume::metres_in(*options.unit), ""};
    if (origin.unit) return {*origin.unit, " (stated in the file)"};
    if (const std::string question = volume::unit_question("the mesh", extent, volume::plausible_bone);
        !question.empty())
        throw Error(fmt::format("{}: {}", options.input.string(), question));
    return {mm, " (assumed)"};
}

// Keeps the components that enclose the largest volumes and orients each outwards.
mesh::Mesh largest_components(const mesh::Mesh& mesh, const mesh::MeshTopology& topology, std::size_t keep) {
    std::vector<mesh::Mesh> parts(topology.components);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        parts[static_cast<std::size_t>(topology.component_of[t])].triangles.push_back(mesh.triangles[t]);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].vertices = mesh.vertices;
        order.push_back({mesh::volume_of(parts[p]), p});
        parts[p].vertices.clear();
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
    mesh::Mesh kept;
    kept.vertices = mesh.vertices;
    if (keep == 0 || keep > order.size()) keep = order.size();
    for (std::size_t n = 0; n < keep; ++n)
        for (auto t : parts[order[n].second].triangles) {
            // The shells of hollows are oriented inwards on purpose, so all components are flipped together with the
            // largest.
            if (order[0].first < 0.0) std::swap(t[1], t[2]);
            kept.triangles.push_back(t);
        }
    return kept;
}

/// The part of a layout that covers a box; at least two samples along each axis. Its samples lie where they were.
volume::Grid part_of(const volume::Grid& layout, const std::array<Vec3, 2>& box) {
    volume::Grid part = layout;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const auto at = [&](double x) { return (x - layout.origin[axis]) / layout.spacing[axis]; };
        const int first = static_cast<int>(std::clamp(std::floor(at(box[0][axis])), 0.0, layout.size[a] - 2.0));
        const int last = static_cast<int>(std::clamp(std::ceil(at(box[1][axis])), first + 1.0, layout.size[a] - 1.0));
        part.origin[axis] = layout.origin[axis] + first * layout.spacing[axis];
        part.size[a] = last - first + 1;
    }
    return part;
}

struct ReadMesh {
    mesh::Mesh mesh;  ///< m
    mesh::MeshOrigin origin;
    Unit unit;
    std::size_t components = 0;
};

ReadMesh read_mesh(const ImportOptions& options, std::vector<std::string>& notes) {
    const std::size_t keep = parse_component(options.component);
    ReadMesh read;
    read.mesh = mesh::load_mesh(options.input, 1.0, &read.origin);
    Vec3 low = read.mesh.vertices.front(), high = low;
    for (const Vec3& v : read.mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    read.unit = unit_of(options, read.origin, std::max({high.x - low.x, high.y - low.y, high.z - low.z}));
    for (Vec3& v : read.mesh.vertices) v *= read.unit.metres;
    const mesh::MeshRepair repaired = mesh::repair(read.mesh, options.input.string());
    if (!repaired.is_clean()) notes.push_back(repaired.describe());
    if (read.origin.without_area > 0)
        notes.push_back(fmt::format("{} triangles without area dropped", read.origin.without_area));
    const mesh::MeshTopology topology = mesh::topology_of(read.mesh);
    read.components = topology.components;
    read.mesh = largest_components(read.mesh, topology, keep);
    return read;
}

/// `coarser`: factor on the default spacing.
volume::Grid layout_of(const mesh::Mesh& mesh, const std::optional<double>& spacing, double coarser = 1.0) {
    const auto corner = [&](const auto& t, std::size_t c) { return mesh.vertices[static_cast<std::size_t>(t[c])]; };
    Vec3 low = corner(mesh.triangles.front(), 0), high = low;
    for (const auto& t : mesh.triangles)
        for (std::size_t c = 0; c < 3; ++c) low = glm::min(low, corner(t, c)), high = glm::max(high, corner(t, c));
    const Vec3 extent = high - low;
    const double default_spacing = std::max(0.4 * mm, std::max({extent.x, extent.y, extent.z}) / 400.0);
    volume::Grid layout{{}, {}, Vec3(spacing.value_or(coarser * default_spacing)), {}};
    layout.origin = low - 4.0 * layout.spacing;
    for (int axis = 0; axis < 3; ++axis) {
        const double steps = std::ceil((high[axis] - low[axis]) / layout.spacing[axis]) + 9.0;
        if (steps > 100000.0) throw Error("the spacing gives more than 100000 voxels along an axis; use a larger one");
        layout.size[static_cast<std::size_t>(axis)] = static_cast<int>(steps);
    }
    return layout;
}

}  // namespace

Bone import_mesh(const ImportOptions& options, const ImportReport& report, ImportSummary& summary) {
    if (!options.crop.empty()) throw Error("--crop is for CT volumes; cut the mesh in a mesh editor");
    report(0.0, "reading");
    const ReadMesh read = read_mesh(options, summary.notes);
    const volume::Grid layout = layout_of(read.mesh, options.spacing);
    check_layout(layout, most_mesh_voxels);
    report(0.3, "distance");
    Bone bone;
    bone.distance = volume::signed_distance(layout, read.mesh, options.run);
    bone.density = assumed_density(bone.distance);
    if (options.mesh_density)
        for (std::size_t n = 0; n < bone.density.values.size(); ++n)
            bone.density.values[n] = bone.distance.values[n] > 0.0f ? 0.0f : static_cast<float>(*options.mesh_density);
    summary.hu = "none";
    summary.components = read.components;
    bone.provenance["calibration"] = options.mesh_density
                                         ? fmt::format("assumed: density = {} kg/m3 throughout", *options.mesh_density)
                                         : assumed_density_law();
    bone.provenance["file_frame"] =
        fmt::format("{}{}", volume::name_of(read.origin.frame), read.origin.frame_stated ? "" : " (assumed)");
    bone.provenance["unit"] = fmt::format("{} m{}", read.unit.metres, read.unit.from);
    return bone;
}

volume::Grid distance_of_mesh(const MeshPart& part) {
    ImportOptions options;
    options.input = part.input;
    options.unit = part.unit;
    std::vector<std::string> notes;
    const ReadMesh read = read_mesh(options, notes);
    volume::Grid layout = layout_of(read.mesh, {}, part.is_coarse ? 2.0 : 1.0);
    if (part.within) layout = part_of(layout, *part.within);
    check_layout(layout, most_mesh_voxels);
    constexpr double sampled = 3.0;  // voxels: what the smoothed gradient of a place on the surface takes in
    return part.is_surface_only ? volume::signed_distance_near(layout, read.mesh, sampled * layout.spacing.x, part.run)
                                : volume::signed_distance(layout, read.mesh, part.run);
}

}  // namespace tactus::bone
