// SPDX-License-Identifier: Apache-2.0
// Steps common to the imports of CTs, meshes and label maps.
#pragma once

#include "assets/bone/import.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "assets/volume/slice_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace tactus::bone {

/// A progress callback that may be empty.
struct ImportReport {
    const ImportProgress& progress;
    void operator()(double share, std::string_view what) const {
        if (progress) progress(share, what);
    }
};

/// The samples of a bone, and its other properties.
struct SparseImport {
    SparseBone bone;
    Bone about;  ///< without samples
};

/// Distance and density from a CT or a closed mesh; name and measurements are still missing.
SparseImport import_ct(const ImportOptions& options, const ImportReport& report, ImportSummary& summary);
Bone import_mesh(const ImportOptions& options, const ImportReport& report, ImportSummary& summary);
/// The same without the density.
Bone import_mesh_shape(const ImportOptions& options, const ImportReport& report, ImportSummary& summary);

/// Throws Error for options that are invalid for every file.
void check_options(const ImportOptions& options);

/// Throws Error if `out` is one of the sources or cannot be written. Called first, because an import takes minutes and
/// must never overwrite a patient's file.
void check_output(const ImportOptions& options, const std::filesystem::path& out);

/// Returns the number of components to keep for "largest", "all" or a number; 0 for all; `otherwise` for "". Throws
/// Error for other text.
std::size_t parse_component(const std::string& text, std::size_t otherwise = 1);

/// Throws Error for more voxels than `most`.
void check_layout(const volume::Grid& layout, double most);

/// Opens a CT or label map. Throws Error if its unit of length must be given, and for options of meshes.
std::unique_ptr<volume::SliceReader> open_scan(const std::filesystem::path& path, const ImportOptions& options,
                                               const std::string& series);

/// Applies the linear calibration to scanner values. Throws Error if the values are not HU and no calibration is given.
void require_hu(volume::ScanVolume& about, const volume::Tally& tally, const ImportOptions& options,
                const std::filesystem::path& file);

/// Sets frame, size, volume, area and densities. Throws Error for a bone without a sample inside.
void measure(const Bone& bone, ImportSummary& summary);
void measure(const SparseBone& bone, ImportSummary& summary, const RunJobs& run);

/// Sets the frame. Throws Error for a bone without a sample inside.
void check_shape(const Bone& bone, ImportSummary& summary);

/// Samples the surface points if the options request them.
void add_points(Bone& bone, const ImportOptions& options, ImportSummary& summary);

/// Sets the provenance of a bone.
void add_provenance(Bone& bone, const ImportOptions& options, const ImportSummary& found,
                    const std::string& source_hash);

/// Returns a hash of a file, or of all files of a folder in the order of their names; 16 hexadecimal digits.
std::string hash_of_source(const std::filesystem::path& path);

}  // namespace tactus::bone
