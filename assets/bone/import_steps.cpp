// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import_steps.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/bone/surface_points.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/volume/length_unit.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace tactus::bone {

namespace {

// A file, or the files of a folder in order of their names.
std::vector<std::filesystem::path> source_files(const std::filesystem::path& input) {
    if (!std::filesystem::is_directory(input)) return {input};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(input))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

void check_options(const ImportOptions& options) {
    if (options.spacing && !(*options.spacing >= 0.01 * mm && *options.spacing <= 100.0 * mm))
        throw Error("the spacing must be between 0.01 and 100 mm");
    if (options.threshold && !std::isfinite(*options.threshold)) throw Error("the threshold must be a number of HU");
    if (options.unit) volume::metres_in(*options.unit);
    if (options.mesh_density && !(*options.mesh_density > 0.0 && *options.mesh_density < 1e5))
        throw Error("the density of a mesh must be above 0 and below 100000 kg/m3");
}

void check_output(const ImportOptions& options, const std::filesystem::path& out) {
    std::error_code ignored;
    for (const std::filesystem::path& source : {options.input, options.ct})
        if (!source.empty() && std::filesystem::equivalent(source, out, ignored))
            throw Error(fmt::format(
                "{}: this is the source, and the bone would overwrite it; give another name with -o", out.string()));
    const std::filesystem::path folder = out.has_parent_path() ? out.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, ignored))
        throw Error(fmt::format("{}: cannot be written: there is no folder {}", out.string(), folder.string()));
    if (std::filesystem::is_directory(out, ignored))
        throw Error(fmt::format("{}: this is a folder; name a file for the bone", out.string()));
}

std::size_t parse_component(const std::string& text, std::size_t otherwise) {
    if (text.empty()) return otherwise;
    if (text == "largest") return 1;
    if (text == "all") return 0;
    std::size_t count = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (code != std::errc{} || end != text.data() + text.size() || count == 0)
        throw Error(fmt::format("component '{}' is not 'largest', 'all' or a number from 1 up", text));
    return count;
}

void check_layout(const volume::Grid& layout, double most) {
    double count = 1.0;
    for (const int n : layout.size) count *= n;
    if (count > most)
        throw Error(
            fmt::format("{:.0f} voxels at {:.3g} mm are too many (at most {:.0f}); use a larger spacing or a crop box",
                        count, layout.spacing.x / mm, most));
}

std::unique_ptr<volume::SliceReader> open_scan(const std::filesystem::path& path, const ImportOptions& options,
                                               const std::string& series) {
    if (options.mesh_density)
        throw Error(fmt::format("{}: --density is for meshes; a scan has its own", path.string()));
    std::unique_ptr<volume::SliceReader> reader = volume::open_volume(path, {series, options.unit, options.fill_gaps});
    if (const std::string question = volume::unit_question(reader->about); !question.empty())
        throw Error(fmt::format("{}: {}", path.string(), question));
    return reader;
}

namespace {

/// Fillings and implants are normal in jaws: the import continues and reports their amount.
void note_metal(std::size_t samples, const Vec3& spacing, ImportSummary& summary) {
    if (samples == 0) return;
    summary.metal_mm3 = static_cast<double>(samples) * spacing.x * spacing.y * spacing.z / (mm * mm * mm);
    summary.notes.push_back(
        fmt::format("{} voxels ({:.3g} mm³) are denser than {:.0f} kg/m³, as metal is; they are "
                    "counted separately from the density of the bone",
                    samples, summary.metal_mm3, max_bone_density));
}

}  // namespace

void check_shape(const Bone& bone, ImportSummary& summary) {
    summary.frame = "LPS";
    if (std::ranges::none_of(bone.distance.values, [](float distance) { return distance < 0.0f; }))
        throw Error("the bone is thinner than a voxel everywhere; use a smaller spacing");
}

void measure(const Bone& bone, ImportSummary& summary) {
    check_shape(bone, summary);
    const geometry::TriangleSurface surface = geometry::iso_surface(bone.distance, 0.0f, false);
    summary.size = bone.distance.size;
    for (int axis = 0; axis < 3; ++axis)
        summary.voxel_mm[static_cast<std::size_t>(axis)] = bone.distance.spacing[axis] / mm;
    summary.bone_volume_mm3 = mesh::volume_of(surface) / (mm * mm * mm);
    summary.surface_area_mm2 = mesh::area_of(surface) / (mm * mm);
    double sum = 0.0, low = std::numeric_limits<double>::infinity(), high = 0.0;
    std::size_t inside = 0, metal = 0;
    for (std::size_t n = 0; n < bone.distance.values.size(); ++n) {
        if (n % (1 << 20) == 0) leave_if_stopped();
        if (bone.distance.values[n] >= 0.0f) continue;
        const double density = bone.density.values[n];
        if (density > max_bone_density) {
            ++metal;
            continue;
        }
        sum += density;
        low = std::min(low, density);
        high = std::max(high, density);
        ++inside;
    }
    note_metal(metal, bone.distance.spacing, summary);
    if (inside == 0) low = high = max_bone_density, sum = high * static_cast<double>(inside = metal);
    summary.density.min = low;
    summary.density.max = high;
    summary.density.mean = sum / static_cast<double>(inside);
}

void measure(const SparseBone& bone, ImportSummary& summary, const RunJobs& run) {
    const BoneMeasures found = measures_of(bone, run);
    note_metal(found.metal, bone.layout.spacing, summary);
    if (found.inside + found.metal == 0)
        throw Error("the bone is thinner than a voxel everywhere; use a smaller spacing");
    summary.frame = "LPS";
    summary.size = bone.layout.size;
    for (int axis = 0; axis < 3; ++axis)
        summary.voxel_mm[static_cast<std::size_t>(axis)] = bone.layout.spacing[axis] / mm;
    summary.bone_volume_mm3 = found.volume / (mm * mm * mm);
    summary.surface_area_mm2 = found.area / (mm * mm);
    summary.density = {found.least, found.most, found.mean};
}

void add_points(Bone& bone, const ImportOptions& options, ImportSummary& summary) {
    if (!options.pointshell) return;
    bone.points =
        surface_points(bone, {.spacing = *options.pointshell, .follow_curvature = options.pointshell_by_curvature},
                       options.run);
    bone.provenance["pointshell"] =
        fmt::format("{} mm{}", *options.pointshell / mm, options.pointshell_by_curvature ? ", by curvature" : "");
    summary.points = bone.points.size();
}

void add_provenance(Bone& bone, const ImportOptions& options, const ImportSummary& found,
                    const std::string& source_hash) {
    bone.provenance["source"] = options.input.filename().string();
    bone.provenance["source_hash"] = source_hash;
    bone.provenance["frame"] = found.frame;
    bone.provenance["hu"] = found.hu;
    for (std::size_t n = 0; n < found.notes.size(); ++n) bone.provenance[fmt::format("note{}", n + 1)] = found.notes[n];
    if (options.spacing) bone.provenance["spacing"] = fmt::format("{} mm", *options.spacing / mm);
}

std::string hash_of_source(const std::filesystem::path& path) {
    Hash hash;
    for (const std::filesystem::path& file : source_files(path)) file::add_file(hash, file);
    return fmt::format("{:016x}", hash.value());
}

}  // namespace tactus::bone
