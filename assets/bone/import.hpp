// SPDX-License-Identifier: Apache-2.0
// Import: a CT volume or a closed mesh becomes a bone.
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

/// What to import and how. Files are LPS and in mm.
struct ImportOptions {
    /// A volume that read_volume takes (NRRD, NIfTI, a DICOM folder or file, InVesalius), or .stl, .ply, .obj.
    std::filesystem::path input;
    std::string series;                 ///< DICOM: which, by its UID or the end of it
    double threshold = 300.0;  ///< HU; bone is what lies at or above. 300 is common for cortex and dense cores
    std::string crop;  ///< "x0:x1,y0:y1,z0:z1" in mm, LPS; empty for everything
    std::string component = "largest";  ///< "largest", "all", or how many of the largest
    std::optional<std::string>
        unit;  ///< of a mesh's coordinates: "mm", "cm" or "m"; mm is assumed when it is plausible
    std::optional<double> spacing;  ///< m, all axes; default: the CT's own; for meshes 0.4 mm or 1/400 of the extent
    bool fill = true;  ///< closed hollows below the threshold are inside the bone
    /// HU = first · value + second, for volumes of scanner numbers.
    std::optional<std::pair<double, double>> rescale;
    /// kg/m³ throughout a mesh; default: an assumed cortex of 1800 over the outer 2 mm and a core of 400.
    std::optional<double> mesh_density;
    std::string label;          ///< a label map: "all", one label's number or its name
    std::filesystem::path ct;   ///< the CT that a label map was drawn on, in the same frame; may be empty
    std::optional<double> pointshell;  ///< m: also spread points over the surface, about one per spacing²
    bool pointshell_by_curvature = false;  ///< closer together where the surface turns
    RunJobs run = run_in_turn;  ///< on which threads; the result has the same bits on any
    int layers_at_once = 0;  ///< of a CT, in memory; 0: some million samples. The result has the same bits with any
};

/// What was imported, for people and programs.
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
    std::size_t components = 0;  ///< found, before any were left out
    std::size_t points = 0;  ///< of the pointshell
    std::vector<std::string> notes;  ///< what was set right or assumed, one sentence each
};

/// Called with the share done in [0, 1] and what is being done.
using ImportProgress = std::function<void(double, std::string_view)>;

/// Reads, checks and converts. Throws Error for input that cannot be a bone, saying what to do. `summary` may be null.
Bone import_bone(const ImportOptions& options, const ImportProgress& progress = {}, ImportSummary* summary = nullptr);

/// The same straight into a bone file. A CT then takes memory for a few of its layers and for what lies near the bone, not
/// for all of it; see ReorientedVolume for files that cannot be read layer by layer.
ImportSummary import_bone_file(const ImportOptions& options, const std::filesystem::path& out,
                               const ImportProgress& progress = {});

struct ImportedBone {
    Bone bone;
    ImportSummary summary;
};

/// One bone per chosen label of a label map, in ascending order of labels, in one frame. Throws Error like import_bone.
std::vector<ImportedBone> import_labels(const ImportOptions& options, const ImportProgress& progress = {});

}  // namespace tactus::bone
