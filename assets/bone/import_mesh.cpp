// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/assumed_density.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/bone/mesh_part.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/repair.hpp"
#include "assets/volume/length_unit.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/surface_distance.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

namespace tactus::bone {

namespace {

constexpr double max_mesh_voxels = 4e8;

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

/// Whether a closed surface encloses a point: the parity of the crossings of a ray, by the majority of three rays.
bool encloses(const mesh::Mesh& mesh, const std::vector<std::array<int, 3>>& triangles, const Vec3& point) {
    constexpr std::array<Vec3, 3> rays{Vec3(0.5377, 0.8338, -0.1259), Vec3(-0.2621, 0.3917, 0.8819),
                                       Vec3(0.7312, -0.5831, 0.3539)};
    int votes = 0;
    for (const Vec3& ray : rays) {
        bool is_inside = false;
        for (const auto& t : triangles) {
            const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
            const Vec3 ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a,
                       ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
            const Vec3 p = glm::cross(ray, ac);
            const double determinant = glm::dot(ab, p);
            if (determinant == 0.0) continue;
            const Vec3 from = point - a;
            const double u = glm::dot(from, p) / determinant;
            if (u < 0.0 || u > 1.0) continue;
            const Vec3 q = glm::cross(from, ab);
            const double v = glm::dot(ray, q) / determinant;
            if (v < 0.0 || u + v > 1.0) continue;
            if (glm::dot(ac, q) / determinant > 0.0) is_inside = !is_inside;
        }
        votes += is_inside;
    }
    return votes >= 2;
}

/// A closed shell of a mesh.
struct Shell {
    std::vector<std::array<int, 3>> triangles;
    double volume = 0.0;  ///< m³, negative when it looks inwards
    Vec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    std::optional<std::size_t> around;  ///< of a hollow: the body that it is in
};

/// Keeps the bodies that enclose the largest volumes, each with its hollows: shells inside it that look inwards, such as
/// the marrow of a bone. Bodies look outwards afterwards. Notes what was left out.
mesh::Mesh largest_bodies(const mesh::Mesh& mesh, const mesh::MeshTopology& topology, std::size_t keep,
                          ImportSummary& summary) {
    std::vector<Shell> shells(topology.components);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Shell& shell = shells[static_cast<std::size_t>(topology.component_of[t])];
        shell.triangles.push_back(mesh.triangles[t]);
        for (const int v : mesh.triangles[t]) {
            shell.low = glm::min(shell.low, mesh.vertices[static_cast<std::size_t>(v)]);
            shell.high = glm::max(shell.high, mesh.vertices[static_cast<std::size_t>(v)]);
        }
    }
    const Vec3 base = mesh.vertices.front();
    for (Shell& shell : shells) {
        const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)] - base; };
        for (const auto& t : shell.triangles) shell.volume += glm::dot(at(t[0]), glm::cross(at(t[1]), at(t[2]))) / 6.0;
    }
    std::vector<std::size_t> order(shells.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::abs(shells[a].volume) > std::abs(shells[b].volume);
    });
    const double outwards = shells[order[0]].volume < 0.0 ? -1.0 : 1.0;
    std::vector<std::size_t> bodies;
    for (const std::size_t n : order) {
        Shell& shell = shells[n];
        if (outwards * shell.volume < 0.0)
            // The smallest body around it; those before it in the order are larger.
            for (auto body = bodies.rbegin(); body != bodies.rend() && !shell.around; ++body) {
                leave_if_stopped();
                const Shell& outer = shells[*body];
                if (glm::all(glm::greaterThanEqual(shell.low, outer.low)) &&
                    glm::all(glm::lessThanEqual(shell.high, outer.high)) &&
                    encloses(mesh, outer.triangles,
                             mesh.vertices[static_cast<std::size_t>(shell.triangles.front()[0])]))
                    shell.around = *body;
            }
        if (!shell.around) bodies.push_back(n);
    }
    summary.components = bodies.size();
    if (keep == 0 || keep > bodies.size()) keep = bodies.size();
    summary.components_kept = keep;
    const std::vector<std::size_t> kept(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(keep));
    mesh::Mesh out;
    out.vertices = mesh.vertices;
    std::size_t hollows = 0;
    double hollow = 0.0, left_out = 0.0;
    for (std::size_t n = 0; n < shells.size(); ++n) {
        const Shell& shell = shells[n];
        const bool is_hollow = shell.around.has_value();
        if (std::ranges::find(kept, is_hollow ? *shell.around : n) == kept.end()) {
            if (!is_hollow) left_out += std::abs(shell.volume);
            continue;
        }
        if (is_hollow) ++hollows, hollow += std::abs(shell.volume);
        // A single body whose faces point inwards is flipped.
        const bool is_turned = is_hollow ? shell.volume > 0.0 : shell.volume < 0.0;
        for (auto t : shell.triangles) {
            if (is_turned) std::swap(t[1], t[2]);
            out.triangles.push_back(t);
        }
    }
    constexpr double mm3 = mm * mm * mm;
    if (hollows > 0)
        summary.notes.push_back(fmt::format("{} inner shell{} looking inwards: {:.0f} mm³ are hollow", hollows,
                                            hollows == 1 ? "" : "s", hollow / mm3));
    if (keep < bodies.size())
        summary.notes.push_back(fmt::format("{} of {} bodies kept; {:.0f} mm³ left out; --component all keeps them",
                                            keep, bodies.size(), left_out / mm3));
    return out;
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
};

ReadMesh read_mesh(const ImportOptions& options, ImportSummary& summary) {
    std::vector<std::string>& notes = summary.notes;
    const std::size_t keep = parse_component(options.component);
    ReadMesh read;
    read.mesh = mesh::load_mesh(options.input, 1.0, &read.origin);
    Vec3 low = read.mesh.vertices.front(), high = low;
    for (const Vec3& v : read.mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    read.unit = unit_of(options, read.origin, std::max({high.x - low.x, high.y - low.y, high.z - low.z}));
    for (Vec3& v : read.mesh.vertices) v *= read.unit.metres;
    notes.insert(notes.end(), read.origin.notes.begin(), read.origin.notes.end());
    const mesh::MeshRepair repaired = mesh::repair(read.mesh, options.input.string());
    if (!repaired.is_clean()) notes.push_back(repaired.describe());
    if (read.origin.without_area > 0)
        notes.push_back(fmt::format("{} triangles without area dropped", read.origin.without_area));
    const mesh::MeshTopology topology = mesh::topology_of(read.mesh);
    read.mesh = largest_bodies(read.mesh, topology, keep, summary);
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

Bone import_mesh_shape(const ImportOptions& options, const ImportReport& report, ImportSummary& summary) {
    if (!options.crop.empty()) throw Error("--crop is for CT volumes; cut the mesh in a mesh editor");
    report(0.0, "reading");
    const ReadMesh read = read_mesh(options, summary);
    const volume::Grid layout = layout_of(read.mesh, options.spacing);
    check_layout(layout, max_mesh_voxels);
    report(0.3, "distance");
    Bone bone;
    bone.distance = volume::signed_distance(layout, read.mesh, options.run);
    summary.hu = "none";
    bone.provenance["calibration"] = options.mesh_density
                                         ? fmt::format("assumed: density = {} kg/m3 throughout", *options.mesh_density)
                                         : assumed_density_law();
    bone.provenance["file_frame"] =
        fmt::format("{}{}", volume::name_of(read.origin.frame), read.origin.frame_stated ? "" : " (assumed)");
    bone.provenance["unit"] = fmt::format("{} m{}", read.unit.metres, read.unit.from);
    return bone;
}

Bone import_mesh(const ImportOptions& options, const ImportReport& report, ImportSummary& summary) {
    Bone bone = import_mesh_shape(options, report, summary);
    bone.density = assumed_density(bone.distance);
    if (options.mesh_density)
        for (std::size_t n = 0; n < bone.density.values.size(); ++n)
            bone.density.values[n] = bone.distance.values[n] > 0.0f ? 0.0f : static_cast<float>(*options.mesh_density);
    return bone;
}

volume::Grid distance_of_mesh(const MeshPart& part) {
    ImportOptions options;
    options.input = part.input;
    options.unit = part.unit;
    ImportSummary ignored;
    const ReadMesh read = read_mesh(options, ignored);
    volume::Grid layout = layout_of(read.mesh, {}, part.is_coarse ? 2.0 : 1.0);
    if (part.within) layout = part_of(layout, *part.within);
    check_layout(layout, max_mesh_voxels);
    constexpr double sampled = 3.0;  // voxels: what the smoothed gradient of a place on the surface takes in
    return part.is_surface_only ? volume::signed_distance_near(layout, read.mesh, sampled * layout.spacing.x, part.run)
                                : volume::signed_distance(layout, read.mesh, part.run);
}

}  // namespace tactus::bone
