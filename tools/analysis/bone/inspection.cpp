// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/inspection.hpp"

#include "assets/bone/ct_threshold.hpp"
#include "assets/bone/labels.hpp"
#include "assets/file/extension.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/volume/length_unit.hpp"
#include "assets/volume/reoriented_volume.hpp"
#include "dsp/geometry/surface_net.hpp"
#include "dsp/volume/components.hpp"
#include "dsp/volume/resample.hpp"
#include "tools/analysis/workers.hpp"

#include <glm/common.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::analysis {

namespace {

constexpr std::size_t max_parts = 20;
constexpr int finest_view = 220;  // samples along the longest side of the drawn surface

std::array<double, 3> in_mm(const Vec3& v) { return {v.x * 1e3, v.y * 1e3, v.z * 1e3}; }

std::array<std::array<double, 2>, 3> bounds_of(const geometry::TriangleSurface& surface) {
    Vec3 low(surface.vertices.front()), high(low);
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    low *= 1e3, high *= 1e3;
    return {{{low.x, high.x}, {low.y, high.y}, {low.z, high.z}}};
}

// Up to the outer faces of the first and last voxels.
std::array<std::array<double, 2>, 3> bounds_of(const volume::Components::Box& box, const volume::Grid& grid) {
    std::array<std::array<double, 2>, 3> bounds{};
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        bounds[a] = {(grid.origin[axis] + (box.first[a] - 0.5) * grid.spacing[axis]) * 1e3,
                     (grid.origin[axis] + (box.last[a] + 0.5) * grid.spacing[axis]) * 1e3};
    }
    return bounds;
}

double voxel_mm3(const volume::Grid& grid) { return grid.spacing.x * grid.spacing.y * grid.spacing.z * 1e9; }

// A border of `outside` samples closes surfaces at the border of the volume.
geometry::TriangleSurface view_surface(const volume::Grid& grid, float iso, float outside) {
    volume::Grid layout = grid;
    double step = 1.0;
    for (const int n : grid.size) step = std::max(step, n / double(finest_view));
    for (std::size_t a = 0; a < 3; ++a) {
        layout.spacing[static_cast<int>(a)] *= step;
        layout.size[a] = std::max(2, static_cast<int>((grid.size[a] - 1) / step) + 1);
    }
    volume::Grid coarse = step > 1.0 ? volume::resampled(grid, layout) : grid;
    for (int k = 0; k < coarse.size[2]; ++k)
        for (int j = 0; j < coarse.size[1]; ++j)
            for (int i = 0; i < coarse.size[0]; ++i)
                if (i == 0 || j == 0 || k == 0 || i == coarse.size[0] - 1 || j == coarse.size[1] - 1 ||
                    k == coarse.size[2] - 1)
                    coarse.at(i, j, k) = outside;
    return geometry::surface_net(coarse, iso, true);
}

void inspect_ct(Inspection& found, volume::HuKind hu, std::optional<double> stated) {
    const volume::Grid& grid = found.grey;
    volume::Histogram histogram = bone::threshold_histogram(found.range[0], found.range[1]);
    volume::add_values(histogram, grid.values);
    const bone::CtThreshold threshold = bone::suggested_threshold(histogram, hu, stated);
    found.threshold = threshold.value;
    found.threshold_from = threshold.how;
    const auto iso = static_cast<float>(*found.threshold);
    const volume::Components components = volume::components_above(grid, iso);
    found.parts_in_all = components.voxels.size();
    for (std::size_t n = 0; n < std::min(components.voxels.size(), max_parts); ++n) {
        if (components.voxels[n] * 1000 < components.voxels[0]) break;
        found.parts.push_back({fmt::format("part {}", n + 1),
                               static_cast<double>(components.voxels[n]) * voxel_mm3(grid),
                               bounds_of(components.boxes[n], grid)});
    }
    const auto low = static_cast<float>(found.range[0]);
    found.surfaces.push_back({view_surface(grid, iso, low), Vec3(0.90, 0.86, 0.76)});
    // Grey window: black well below the threshold, white at the densest values.
    found.window = {found.hu == "calibrated" ? std::max(found.range[0], -200.0) : found.range[0],
                    std::max(*found.threshold * 3.0, *found.threshold + 200.0)};
}

// Adds the labels of a map, which are those of one layer when segments overlap.
void inspect_labels(Inspection& found, const volume::Grid& grid, const volume::ScanVolume& volume) {
    struct Seen {
        std::size_t voxels = 0;
        volume::Components::Box box{};
    };
    std::map<int, Seen> seen;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const int label = static_cast<int>(grid.at(i, j, k));
                if (label == 0) continue;
                Seen& s = seen[label];
                const std::array<int, 3> at{i, j, k};
                if (s.voxels++ == 0) s.box = {at, at};
                for (std::size_t a = 0; a < 3; ++a)
                    s.box.first[a] = std::min(s.box.first[a], at[a]), s.box.last[a] = std::max(s.box.last[a], at[a]);
            }
    for (const auto& [label, s] : seen) {
        std::string name = fmt::format("label {}", label);
        Vec3 colour = bone::label_colour(label);
        for (const volume::Segment& segment : volume.segments)
            if (segment.label == label) {
                if (!segment.name.empty()) name += ": " + segment.name;
                colour = segment.colour.value_or(colour);
            }
        found.parts.push_back({name, static_cast<double>(s.voxels) * voxel_mm3(grid), bounds_of(s.box, grid)});
        volume::Grid mask = grid;
        for (float& value : mask.values) value = value == static_cast<float>(label) ? 1.0f : 0.0f;
        if (found.surfaces.size() < max_parts) found.surfaces.push_back({view_surface(mask, 0.5f, 0.0f), colour});
    }
    found.parts_in_all = found.parts.size();
    found.is_labels = true;
}

void inspect_segments(Inspection& found, volume::SliceReader& reader) {
    const std::size_t named = reader.about.segments.size();
    if (reader.layer_count() < 2) inspect_labels(found, found.grey, reader.about);
    for (int layer = 0; layer < reader.layer_count() && reader.layer_count() > 1; ++layer) {
        reader.show_layer(layer);
        volume::ReorientedVolume layers(reader, on_threads());
        if (layers.is_turned()) layers.settle();
        inspect_labels(found, volume::whole_of(layers), reader.about);
    }
    std::vector<std::string> empty;
    for (const volume::Segment& segment : reader.about.segments)
        if (std::ranges::none_of(found.parts, [&](const InspectedPart& part) {
                return part.name == fmt::format("label {}", segment.label) ||
                       part.name.starts_with(fmt::format("label {}: ", segment.label));
            }))
            empty.push_back(segment.name.empty() ? fmt::format("label {}", segment.label) : segment.name);
    if (!empty.empty())
        found.notes.push_back(
            fmt::format("of {} named segments {} have no voxels: {}", named, empty.size(), fmt::join(empty, ", ")));
}

Inspection inspect_volume(const std::filesystem::path& path, const InspectionOptions& options) {
    const std::unique_ptr<volume::SliceReader> reader =
        volume::open_volume(path, {options.series, options.unit, options.fill_gaps});
    volume::ReorientedVolume layers(*reader, on_threads());
    layers.set_line(options.rescale);
    if (layers.is_turned()) layers.settle();
    Inspection found;
    found.grey = volume::whole_of(layers);
    layers.settle();
    volume::ScanVolume& about = reader->about;
    if (options.rescale && about.kind == volume::VolumeKind::ct) about.hu = volume::HuKind::calibrated;
    found.kind = volume::name_of(about.kind);
    found.frame = volume::name_of(about.file_frame);
    found.hu = volume::name_of(about.hu);
    found.size = about.size;
    found.spacing_mm = in_mm(about.spacing());
    found.uniform = about.uniform;
    found.tilt_deg = about.tilt_deg();
    found.notes = about.notes;
    found.histogram = volume::histogram_of(found.grey.values, 24);
    found.range = {layers.range().first, layers.range().second};
    found.is_in_hu = volume::are_hu(about.hu, found.range[1]);
    if (!found.is_in_hu && about.kind == volume::VolumeKind::ct)
        found.notes.push_back(
            "the values are not HU, as of MR, of 8-bit images or of a scan without calibration; 'import' needs "
            "--hu-calibration or --rescale");
    found.unit_question = volume::unit_question(about);
    found.unit = found.unit_question.empty() ? "mm" : "";
    if (about.kind == volume::VolumeKind::labels) inspect_segments(found, *reader);
    else inspect_ct(found, about.hu, options.rescale ? std::nullopt : about.surface_hu);
    return found;
}

// The unit of a mesh, m; mm where it must be asked for.
double settle_unit(const mesh::Mesh& mesh, const mesh::MeshOrigin& origin, const std::optional<std::string>& given,
                   Inspection& found) {
    if (given) {
        found.unit = *given;
        return volume::metres_in(*given);
    }
    if (origin.unit) {
        found.unit = *origin.unit < 5e-3 ? "mm" : *origin.unit < 0.5 ? "cm" : "m";
        return *origin.unit;
    }
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& v : mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const Vec3 size = high - low;
    found.unit_question = volume::unit_question("the mesh", std::max({size.x, size.y, size.z}), volume::plausible_bone);
    found.unit = found.unit_question.empty() ? "mm" : "";
    return 1e-3;
}

Inspection inspect_mesh(const std::filesystem::path& path, const std::optional<std::string>& given) {
    mesh::MeshOrigin origin;
    const mesh::Mesh mesh = mesh::load_mesh(path, 1.0, &origin);
    const mesh::MeshTopology topology = mesh::topology_of(mesh);
    Inspection found;
    found.kind = "mesh";
    found.frame = volume::name_of(origin.frame);
    found.hu = "none";
    const double unit = settle_unit(mesh, origin, given, found);
    std::vector<geometry::TriangleSurface> parts(topology.components);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        parts[static_cast<std::size_t>(topology.component_of[t])].triangles.push_back(mesh.triangles[t]);
    for (geometry::TriangleSurface& part : parts) {
        // Only the points of the part.
        std::map<int, int> renamed;
        for (auto& t : part.triangles)
            for (int& corner : t) {
                const auto [at, fresh] = renamed.insert({corner, static_cast<int>(part.vertices.size())});
                if (fresh) part.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)] * unit);
                corner = at->second;
            }
        found.parts.push_back({"", mesh::volume_of(part) * 1e9, bounds_of(part)});
        found.surfaces.push_back({std::move(part), Vec3(0.90, 0.86, 0.76)});
    }
    std::stable_sort(found.parts.begin(), found.parts.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.volume_mm3) > std::abs(b.volume_mm3); });
    found.parts_in_all = found.parts.size();
    const bool looks_outwards = found.parts.front().volume_mm3 >= 0.0;
    std::size_t inner = 0;
    for (std::size_t n = 0; n < found.parts.size(); ++n) {
        InspectedPart& part = found.parts[n];
        // Against the largest: the hollow of a body that is around it.
        const bool is_inner = part.volume_mm3 != 0.0 && (part.volume_mm3 > 0.0) != looks_outwards;
        inner += is_inner;
        part.name = fmt::format("part {}{}", n + 1, is_inner ? ", an inward-facing shell" : "");
        part.volume_mm3 = std::abs(part.volume_mm3);
    }
    if (found.parts.size() > max_parts) found.parts.resize(max_parts);
    found.notes = origin.notes;
    if (inner > 0)
        found.notes.push_back(
            fmt::format("{} inward-facing shell{}; 'tactus import' treats {} as a cavity of the surrounding body",
                        inner, inner == 1 ? "" : "s", inner == 1 ? "it" : "each"));
    found.notes.push_back(fmt::format("{} points, {} triangles; coordinates {}", mesh.vertices.size(),
                                      mesh.triangles.size(),
                                      given                         ? "in " + *given
                                      : origin.unit                 ? "in " + found.unit + ", as the file states"
                                      : found.unit_question.empty() ? "taken as mm"
                                                                    : "in an unknown unit"));
    if (!topology.is_watertight())
        found.notes.push_back(
            fmt::format("not watertight: {} boundary, {} non-manifold and {} flipped edges; volumes are rough",
                        topology.boundary_edges, topology.non_manifold_edges, topology.flipped_edges));
    return found;
}

Inspection inspect_bones(const std::filesystem::path& path) {
    std::vector<bone::Bone> bones;
    if (bone::file_of_bone(path) == path) bones = bone::load_bones(path);
    else bones.push_back(bone::load_bone(path));
    Inspection found;
    found.kind = "bone";
    found.unit = "mm";
    found.frame = "LPS";
    const bone::Bone& first = bones.front();
    const auto hu = first.provenance.find("hu");
    found.hu = hu == first.provenance.end() ? "none" : hu->second;
    found.size = first.distance.size;
    found.spacing_mm = in_mm(first.distance.spacing);
    found.range = {1e30, -1e30};
    for (const bone::Bone& bone : bones) {
        for (std::size_t n = 0; n < bone.density.values.size(); ++n)
            if (bone.distance.values[n] < 0.0f) {
                found.range[0] = std::min(found.range[0], double(bone.density.values[n]));
                found.range[1] = std::max(found.range[1], double(bone.density.values[n]));
            }
        geometry::TriangleSurface surface = mesh::export_surface(bone.distance);
        if (surface.vertices.empty()) {
            found.notes.push_back(fmt::format("'{}' has no surface", bone.name));
            continue;
        }
        found.parts.push_back({bone.name, mesh::volume_of(surface) * 1e9, bounds_of(surface)});
        found.surfaces.push_back({std::move(surface), bone.colour});
        double painted = 0.0;
        found.painted.emplace_back();
        for (const contact::SurfacePoint& point : bone.points)
            if (point.label == contact::surface_label::fracture) {
                found.painted.back().push_back({point.position, point.normal});
                painted += point.area;
            }
        if (painted > 0.0)
            found.notes.push_back(
                fmt::format("'{}': {:.0f} mm² painted as fracture, red in the picture", bone.name, painted * 1e6));
    }
    if (found.range[0] > found.range[1]) found.range = {0.0, 0.0};
    found.parts_in_all = found.parts.size();
    found.grey = first.density;
    for (std::size_t n = 0; n < found.grey.values.size(); ++n)
        if (first.distance.values[n] >= 0.0f) found.grey.values[n] *= 0.3f;
    found.histogram = volume::histogram_of(first.density.values, 24);
    found.window = {0.0, std::max(found.range[1], 1.0)};
    for (const auto& [key, value] : first.provenance) found.notes.push_back(key + ": " + value);
    return found;
}

}  // namespace

Inspection inspect(const std::filesystem::path& path, const InspectionOptions& options) {
    const std::string kind = file::extension_of(path);
    if (file::extension_of(bone::file_of_bone(path)) == ".vdb") return inspect_bones(path);
    if (kind == ".stl" || kind == ".ply" || kind == ".obj") return inspect_mesh(path, options.unit);
    return inspect_volume(path, options);
}

}  // namespace tactus::analysis
