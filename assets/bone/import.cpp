// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import.hpp"

#include "assets/bone/assumed_density.hpp"
#include "assets/bone/from_hu.hpp"
#include "assets/bone/labels.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/repair.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/distance/resample.hpp"
#include "dsp/distance/surface_distance.hpp"

#include <glm/common.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace tactus {

namespace {

constexpr double mm = 1e-3;
constexpr double most_voxels = 4e8;

struct Range {
    Vec3 low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};  // m
};

Range parse_crop(const std::string& text) {
    Range range;
    if (text.empty()) return range;
    int read = 0;
    Vec3 &a = range.low, &b = range.high;
    const int found = std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf,%lf:%lf%n", &a.x, &b.x, &a.y, &b.y, &a.z, &b.z, &read);
    if (found != 6 || read != static_cast<int>(text.size()) || !is_finite(a) || !is_finite(b) || a.x >= b.x ||
        a.y >= b.y || a.z >= b.z)
        throw Error(fmt::format("crop box '{}' is not x0:x1,y0:y1,z0:z1 in mm with x0 < x1, y0 < y1, z0 < z1", text));
    a *= mm;
    b *= mm;
    return range;
}

std::size_t parse_component(const std::string& text) {
    if (text == "largest") return 1;
    if (text == "all") return 0;
    std::size_t count = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (code != std::errc{} || end != text.data() + text.size() || count == 0)
        throw Error(fmt::format("component '{}' is not 'largest', 'all' or a number from 1 up", text));
    return count;
}

void check_layout(const Grid& layout) {
    double count = 1.0;
    for (const int n : layout.size) count *= n;
    if (count > most_voxels)
        throw Error(
            fmt::format("{:.0f} voxels at {:.3g} mm are too many (at most {:.0f}); use a larger spacing or a crop box",
                        count, layout.spacing.x / mm, most_voxels));
}

// Samples of the result: the file's own within the box, or new ones at `spacing`.
Grid ct_layout(const Grid& ct, const Range& crop, std::optional<double> spacing) {
    Grid layout{{}, {}, spacing ? Vec3(*spacing) : ct.spacing, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double last = ct.origin[axis] + (ct.size[a] - 1) * ct.spacing[axis];
        double low = std::max(crop.low[axis], ct.origin[axis]);
        const double high = std::min(crop.high[axis], last);
        if (!spacing)
            low = ct.origin[axis] + std::ceil((low - ct.origin[axis]) / ct.spacing[axis] - 1e-9) * ct.spacing[axis];
        const double steps = std::floor((high - low) / layout.spacing[axis] + 1e-9);
        if (!(steps >= 2.0))
            throw Error(fmt::format("the crop box leaves no volume along {}: the file spans {:.1f} to {:.1f} mm there",
                                    "xyz"[axis], ct.origin[axis] / mm, last / mm));
        if (steps > 100000.0) throw Error("the spacing gives more than 100000 voxels along an axis; use a larger one");
        layout.origin[axis] = low;
        layout.size[a] = static_cast<int>(steps) + 1;
    }
    check_layout(layout);
    return layout;
}

// Turns scanner numbers to HU where a line is given. Throws Error when the numbers cannot be HU and none is.
void require_hu(ScanVolume& volume, const ImportOptions& options, const std::filesystem::path& file) {
    if (options.rescale) {
        for (float& value : volume.values)
            value = static_cast<float>(options.rescale->first * double(value) + options.rescale->second);
        volume.hu = HuKind::calibrated;
    }
    if (volume.hu != HuKind::scanner) return;
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    throw Error(
        fmt::format("{}: values {:g} to {:g} are not HU (no air near -1000): scanner numbers. Say which of them are "
                    "which HU, as in --hu-calibration 60:-1000,1100:40 (air and water or muscle), or convert the "
                    "file first",
                    file.string(), *low, *high));
}

// "1 (femur), 2": what the structures of a label map are called.
std::string list_of_labels(const ScanVolume& volume) {
    std::set<int> found;
    for (const float value : volume.values)
        if (value > 0.0f && value <= 65535.0f) found.insert(static_cast<int>(value));
    std::vector<std::string> words;
    for (const int label : found) {
        const auto named = std::find_if(volume.segments.begin(), volume.segments.end(),
                                        [&](const Segment& s) { return s.label == label && !s.name.empty(); });
        words.push_back(named == volume.segments.end() ? std::to_string(label)
                                                       : fmt::format("{} ({})", label, named->name));
        if (words.size() == 12) break;
    }
    return words.empty() ? "it holds none"
                         : fmt::format("it holds {}{}", fmt::join(words, ", "), found.size() > 12 ? ", ..." : "");
}

struct Report {
    const ImportProgress& progress;
    void operator()(double share, std::string_view what) const {
        if (progress) progress(share, what);
    }
};

Bone import_ct(const ImportOptions& options, const Report& report, ImportSummary& summary) {
    const Range crop = parse_crop(options.crop);
    const std::size_t keep = parse_component(options.component);
    report(0.0, "reading");
    ScanVolume volume = read_volume(options.input, {options.series});
    if (volume.kind == VolumeKind::labels && !options.rescale)
        throw Error(
            fmt::format("{}: a label map, not a CT: its values are numbers of structures. Say which of them is the "
                        "bone with --label N or its name, or --label all for one bone each ({})",
                        options.input.string(), list_of_labels(volume)));
    require_hu(volume, options, options.input);
    summary.hu = name_of(volume.hu);
    summary.notes = volume.notes;
    const Frame file_frame = volume.file_frame;
    const std::string encoding = volume.encoding;
    const bool turned = is_turned(volume);
    Grid ct = lps_grid(std::move(volume));
    const Grid layout = ct_layout(ct, crop, options.spacing);
    report(0.2, "resampling");
    Grid hu = resampled(std::move(ct), layout);
    report(0.4, "surface and distance");
    HuBone made = bone_from_hu(std::move(hu), {static_cast<float>(options.threshold), keep, options.fill}, options.run);
    summary.components = made.components;
    made.bone.provenance["encoding"] = encoding;
    made.bone.provenance["file_frame"] = name_of(file_frame);
    if (turned) made.bone.provenance["axes"] = "turned; resampled to LPS";
    if (options.rescale)
        made.bone.provenance["rescale"] =
            fmt::format("HU = {} * value + {}", options.rescale->first, options.rescale->second);
    return std::move(made.bone);
}

double unit_of(const ImportOptions& options, double extent) {
    if (options.unit) {
        if (*options.unit == "mm") return mm;
        if (*options.unit == "cm") return 10.0 * mm;
        if (*options.unit == "m") return 1.0;
        throw Error(fmt::format("unit '{}' is not mm, cm or m", *options.unit));
    }
    if (extent < 5.0 || extent > 2000.0) {
        const std::string_view likely = extent < 0.005 ? "" : extent <= 2.0 ? "m" : extent < 5.0 ? "cm" : "";
        throw Error(
            fmt::format("{}: {:.3g} across cannot be mm for a bone; say what its coordinates are with --unit mm, cm "
                        "or m{}",
                        options.input.string(), extent,
                        likely.empty() ? ""
                                       : fmt::format(" (--unit {} would make it {:.0f} mm)", likely,
                                                     extent * (likely == "m" ? 1000.0 : 10.0))));
    }
    return mm;
}

// Keeps the components of largest enclosed volume, each turned to look outwards.
Mesh largest_components(const Mesh& mesh, const MeshTopology& topology, std::size_t keep) {
    std::vector<Mesh> parts(topology.components);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        parts[static_cast<std::size_t>(topology.component_of[t])].triangles.push_back(mesh.triangles[t]);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].vertices = mesh.vertices;
        order.push_back({volume_of(parts[p]), p});
        parts[p].vertices.clear();
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
    Mesh kept;
    kept.vertices = mesh.vertices;
    if (keep == 0 || keep > order.size()) keep = order.size();
    for (std::size_t n = 0; n < keep; ++n)
        for (auto t : parts[order[n].second].triangles) {
            // Shells of hollows look inwards on purpose, so all components turn with the largest.
            if (order[0].first < 0.0) std::swap(t[1], t[2]);
            kept.triangles.push_back(t);
        }
    return kept;
}

Bone import_mesh(const ImportOptions& options, const Report& report, ImportSummary& summary) {
    if (!options.crop.empty()) throw Error("a crop box is for CT volumes; cut the mesh in a mesh editor");
    const std::size_t keep = parse_component(options.component);
    report(0.0, "reading");
    MeshOrigin origin;
    Mesh mesh = load_mesh(options.input, 1.0, &origin);
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& v : mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const auto widest = [](const Vec3& v) { return std::max({v.x, v.y, v.z}); };
    const double unit = unit_of(options, widest(high - low));
    for (Vec3& v : mesh.vertices) v *= unit;
    const MeshRepair repaired = repair(mesh, options.input.string());
    if (!repaired.is_clean()) summary.notes.push_back(repaired.describe());
    if (origin.without_area > 0)
        summary.notes.push_back(fmt::format("{} triangles without area dropped", origin.without_area));
    const MeshTopology topology = topology_of(mesh);
    mesh = largest_components(mesh, topology, keep);
    const auto corner = [&](const auto& t, std::size_t c) { return mesh.vertices[static_cast<std::size_t>(t[c])]; };
    low = high = corner(mesh.triangles.front(), 0);
    for (const auto& t : mesh.triangles)
        for (std::size_t c = 0; c < 3; ++c) low = glm::min(low, corner(t, c)), high = glm::max(high, corner(t, c));
    Grid layout{{}, {}, Vec3(options.spacing.value_or(std::max(0.4 * mm, widest(high - low) / 400.0))), {}};
    layout.origin = low - 4.0 * layout.spacing;
    for (int axis = 0; axis < 3; ++axis) {
        const double steps = std::ceil((high[axis] - low[axis]) / layout.spacing[axis]) + 9.0;
        if (steps > 100000.0) throw Error("the spacing gives more than 100000 voxels along an axis; use a larger one");
        layout.size[static_cast<std::size_t>(axis)] = static_cast<int>(steps);
    }
    check_layout(layout);
    report(0.3, "distance");
    Bone bone;
    bone.distance = signed_distance(layout, mesh, options.run);
    bone.density = assumed_density(bone.distance);
    if (options.mesh_density)
        for (std::size_t n = 0; n < bone.density.values.size(); ++n)
            bone.density.values[n] = bone.distance.values[n] > 0.0f ? 0.0f : static_cast<float>(*options.mesh_density);
    summary.hu = "none";
    summary.components = topology.components;
    bone.provenance["calibration"] = options.mesh_density
                                         ? fmt::format("assumed: density = {} kg/m3 throughout", *options.mesh_density)
                                         : assumed_density_law();
    bone.provenance["file_frame"] = fmt::format("{}{}", name_of(origin.frame), origin.frame_stated ? "" : " (assumed)");
    bone.provenance["unit"] = fmt::format("{} m{}", unit, options.unit ? "" : " (assumed)");
    return bone;
}

void add_points(Bone& bone, const ImportOptions& options, ImportSummary& summary) {
    if (!options.pointshell) return;
    bone.points = sample_surface(bone.distance,
                                 {.spacing = *options.pointshell, .follow_curvature = options.pointshell_by_curvature});
    bone.provenance["pointshell"] =
        fmt::format("{} mm{}", *options.pointshell / mm, options.pointshell_by_curvature ? ", by curvature" : "");
    summary.points = bone.points.size();
}

void measure(const Bone& bone, ImportSummary& summary) {
    const TriangleSurface surface = iso_surface(bone.distance, 0.0f, false);
    summary.frame = "LPS";
    summary.size = bone.distance.size;
    for (int axis = 0; axis < 3; ++axis)
        summary.voxel_mm[static_cast<std::size_t>(axis)] = bone.distance.spacing[axis] / mm;
    summary.bone_volume_mm3 = volume_of(surface) / (mm * mm * mm);
    summary.surface_area_mm2 = area_of(surface) / (mm * mm);
    double sum = 0.0, low = std::numeric_limits<double>::infinity(), high = 0.0;
    std::size_t inside = 0;
    for (std::size_t n = 0; n < bone.distance.values.size(); ++n) {
        if (bone.distance.values[n] >= 0.0f) continue;
        const double density = bone.density.values[n];
        sum += density;
        low = std::min(low, density);
        high = std::max(high, density);
        ++inside;
    }
    if (inside == 0) throw Error("the bone is thinner than a voxel everywhere; use a smaller spacing");
    summary.density.min = low;
    summary.density.max = high;
    summary.density.mean = sum / static_cast<double>(inside);
}

// What every bone of an import is told about where it came from.
void add_provenance(Bone& bone, const ImportOptions& options, const ImportSummary& found,
                    const std::string& source_hash) {
    bone.provenance["source"] = options.input.filename().string();
    bone.provenance["source_hash"] = source_hash;
    bone.provenance["frame"] = found.frame;
    bone.provenance["hu"] = found.hu;
    for (std::size_t n = 0; n < found.notes.size(); ++n) bone.provenance[fmt::format("note{}", n + 1)] = found.notes[n];
    if (options.spacing) bone.provenance["spacing"] = fmt::format("{} mm", *options.spacing / mm);
}

// A file, or all files of a folder by their names.
std::vector<std::filesystem::path> source_files(const std::filesystem::path& input) {
    if (!std::filesystem::is_directory(input)) return {input};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(input))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// "jaw" of jaw.nii.gz and of the folder jaw/.
std::string bone_name(const std::filesystem::path& input) {
    const std::filesystem::path last = input.filename().empty() ? input.parent_path().filename() : input.filename();
    return (last.extension() == ".gz" ? last.stem() : last).stem().string();
}

std::string hash_of_source(const std::filesystem::path& path) {
    Hash hash;
    for (const std::filesystem::path& file : source_files(path)) add_file(hash, file);
    return fmt::format("{:016x}", hash.value());
}

void check(const ImportOptions& options) {
    if (options.spacing && !(*options.spacing >= 0.01 * mm && *options.spacing <= 100.0 * mm))
        throw Error("the spacing must be between 0.01 and 100 mm");
    if (!std::isfinite(options.threshold)) throw Error("the threshold must be a number of HU");
    if (options.mesh_density && !(*options.mesh_density > 0.0 && *options.mesh_density < 1e5))
        throw Error("the density of a mesh must be above 0 and below 100000 kg/m3");
}

// Those of the map that `wanted` means: "all", a number, or a name that the file gives.
std::vector<Segment> choose_segments(const std::string& wanted, const std::vector<int>& labels,
                                     const std::vector<Segment>& named, const std::string& file) {
    if (labels.empty()) throw Error(fmt::format("{}: every voxel is 0; there is no label", file));
    std::vector<Segment> all;
    std::vector<std::string> names;
    for (const int label : labels) {
        const auto known = std::find_if(named.begin(), named.end(), [&](const Segment& s) { return s.label == label; });
        all.push_back(known != named.end() ? *known : Segment{label, "", {}});
        // A name that another label has already would not tell them apart.
        if (all.back().name.empty() || std::count(names.begin(), names.end(), all.back().name) > 0)
            all.back().name = fmt::format("label {}", label);
        names.push_back(all.back().name);
    }
    if (wanted == "all") return all;
    for (const Segment& segment : all)
        if (wanted == std::to_string(segment.label) || wanted == segment.name) return {segment};
    throw Error(fmt::format("{}: has no label '{}' but {}{}", file, wanted, fmt::join(labels, ", "),
                            did_you_mean(wanted, names)));
}

}  // namespace

std::vector<ImportedBone> import_labels(const ImportOptions& options, const ImportProgress& progress) {
    check(options);
    if (!options.crop.empty()) throw Error("a crop box is for CT volumes; a label map's bones are cut out already");
    const Report report{progress};
    report(0.0, "reading");
    ScanVolume volume = read_volume(options.input, {options.series});
    volume.kind = VolumeKind::labels;
    const std::vector<Segment> named = volume.segments;
    const std::vector<std::string> notes = volume.notes;
    const Grid map = lps_grid(std::move(volume));
    const std::vector<Segment> chosen = choose_segments(options.label, labels_in(map), named, options.input.string());
    LabelBone how;
    how.spacing = options.spacing;
    Grid ct;
    HuKind hu = HuKind::none;
    if (!options.ct.empty()) {
        ScanVolume grey = read_volume(options.ct);
        require_hu(grey, options, options.ct);
        hu = grey.hu;
        ct = lps_grid(std::move(grey));
        how.hu = &ct;
        how.hu_is_masked = hu == HuKind::masked;
    }
    const std::string source_hash = hash_of_source(options.input);
    std::vector<ImportedBone> bones;
    for (const Segment& segment : chosen) {
        report(0.1 + 0.9 * static_cast<double>(bones.size()) / static_cast<double>(chosen.size()), segment.name);
        ImportedBone made;
        made.bone = bone_of_label(map, segment, how, options.run);
        made.summary.hu = name_of(hu);
        made.summary.notes = notes;
        made.summary.components = 1;
        measure(made.bone, made.summary);
        add_points(made.bone, options, made.summary);
        add_provenance(made.bone, options, made.summary, source_hash);
        if (!options.ct.empty()) made.bone.provenance["ct"] = options.ct.filename().string();
        bones.push_back(std::move(made));
    }
    report(1.0, "done");
    return bones;
}

Bone import_bone(const ImportOptions& options, const ImportProgress& progress, ImportSummary* summary) {
    check(options);
    const Report report{progress};
    ImportSummary found;
    Bone bone = is_volume_file(options.input) ? import_ct(options, report, found) : import_mesh(options, report, found);
    report(0.9, "measuring");
    measure(bone, found);
    add_points(bone, options, found);
    add_provenance(bone, options, found, hash_of_source(options.input));
    bone.name = bone_name(options.input);
    bone.provenance["component"] = options.component;
    bone.provenance["fill"] = options.fill ? "true" : "false";
    if (!options.crop.empty()) bone.provenance["crop"] = options.crop + " mm";
    if (summary) *summary = found;
    report(1.0, "done");
    return bone;
}

}  // namespace tactus
