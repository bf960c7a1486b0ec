// SPDX-License-Identifier: Apache-2.0
// Imports a CT volume or a closed mesh as a bone.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/jobs.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::bone {

/// Source and settings of an import. Files are LPS and in mm.
struct ImportOptions {
    /// A volume for read_volume (NRRD, NIfTI, a DICOM folder or file, InVesalius), or a mesh: .stl, .ply, .obj.
    std::filesystem::path input;
    std::string series;                 ///< DICOM: the series to read, by its UID or the last part of it
    /// HU; samples at or above it are bone. Default: suggested_threshold of the whole volume, which `info` prints.
    std::optional<double> threshold;
    bool fill_gaps = false;             ///< DICOM: interpolate missing slices; otherwise such a series is rejected
    std::string crop;  ///< "x0:x1,y0:y1,z0:z1" in mm, LPS; empty for everything
    /// "largest", "all", or the number of components to keep, largest first. Default: all for a label, otherwise the
    /// largest.
    std::string component;
    /// Unit of length: "mm", "cm" or "m". Default: the unit in the file, or mm if that is plausible for a bone.
    std::optional<std::string> unit;
    std::optional<double> spacing;  ///< m, all axes; default: the CT's own; for meshes 0.4 mm or 1/400 of the extent
    bool fill = true;  ///< of a CT: count closed hollows and marrow behind a leaky shell as bone, with their density
    /// HU = first · value + second, for volumes with uncalibrated scanner values.
    std::optional<std::pair<double, double>> rescale;
    /// Uniform density of a mesh, kg/m³; default: an assumed cortex of 1800 to 2 mm depth and a core of 400.
    std::optional<double> mesh_density;
    std::string label;  ///< a label map: "all", one label's number or its name
    std::filesystem::path ct;  ///< the CT of a label map, in the same frame; may be empty
    std::optional<double> pointshell;  ///< m: also samples points on the surface, about one per spacing²
    bool pointshell_by_curvature = false;  ///< denser where the curvature is high
    RunJobs run = run_in_turn;  ///< threads; the result does not depend on them
    int layers_at_once =
        0;  ///< layers of a CT in memory; 0: some million samples. Does not change the bits of the result
};

/// Summary of an import.
struct ImportSummary {
    std::string frame;  ///< "LPS"
    std::string hu;  ///< "calibrated", "masked" (0 instead of air) or "none" (a mesh)
    std::array<double, 3> voxel_mm{};
    std::array<int, 3> size{};
    double bone_volume_mm3 = 0.0;  ///< enclosed by the surface
    double surface_area_mm2 = 0.0;
    struct {
        double min = 0.0, max = 0.0, mean = 0.0;
    } density;  ///< kg/m³ over the samples inside
    double metal_mm3 = 0.0;  ///< inside, above max_bone_density (fillings, implants); excluded from `density`
    std::size_t components = 0;  ///< found, before selection
    std::size_t components_kept = 0;
    /// For a CT, volume below the threshold: hollows that bone encloses completely, and marrow behind a leaky shell.
    double hollow_mm3 = 0.0, marrow_mm3 = 0.0;
    struct {
        std::optional<double> hu;  ///< for a CT; none for meshes and label maps
        std::string from;  ///< "given", or "suggested: " and the method
        double above_mm3 = 0.0;  ///< all voxels at or above it
        double kept_mm3 = 0.0;  ///< those in the kept components
        std::optional<double> mask_mm3;  ///< for a masked CT: all voxels that are not 0
    } threshold;
    std::size_t points = 0;  ///< number of pointshell points
    std::vector<std::string> notes;  ///< corrections and assumptions, one sentence each
};

/// Called with the progress in [0, 1] and the current step.
using ImportProgress = std::function<void(double, std::string_view)>;

/// Reads, checks and converts. Throws Error with a remedy for input that cannot be converted. `summary` may be null.
Bone import_bone(const ImportOptions& options, const ImportProgress& progress = {}, ImportSummary* summary = nullptr);

/// The same, written to a bone file. For a CT, memory is needed only for a few of its layers and for the blocks near
/// the bone; see ReorientedVolume for formats that cannot be read layer by layer.
ImportSummary import_bone_file(const ImportOptions& options, const std::filesystem::path& out,
                               const ImportProgress& progress = {});

struct ImportedBone {
    Bone bone;
    ImportSummary summary;
};

/// One bone per selected label of a label map, in ascending order of labels, in one frame. Throws Error like
/// import_bone.
std::vector<ImportedBone> import_labels(const ImportOptions& options, const ImportProgress& progress = {});

}  // namespace tactus::bone
