// SPDX-License-Identifier: Apache-2.0
// The steps that importing a CT, a mesh and a label map share.
#pragma once

#include "assets/bone/import.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "assets/volume/slice_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::bone {

/// Progress that may be listened to by nobody.
struct ImportReport {
    const ImportProgress& progress;
    void operator()(double share, std::string_view what) const {
        if (progress) progress(share, what);
    }
};

/// A bone's samples, and what is known about it beside them.
struct SparseImport {
    SparseBone bone;
    Bone about;  ///< without samples
};

/// Bone and density of a CT, or of a closed mesh; neither named nor measured yet.
SparseImport import_ct(const ImportOptions& options, const ImportReport& report, ImportSummary& summary);
Bone import_mesh(const ImportOptions& options, const ImportReport& report, ImportSummary& summary);

/// Throws Error for options that no file could be imported with.
void check_options(const ImportOptions& options);

/// Throws Error when `out` is one of the sources, or cannot be written: before minutes are spent on it, and before a
/// patient's file is lost.
void check_output(const ImportOptions& options, const std::filesystem::path& out);

/// How many of the largest components "largest", "all" or a number keeps; 0 for all. Throws Error for anything else.
std::size_t parse_component(const std::string& text);

/// Throws Error for more voxels than `most`.
void check_layout(const volume::Grid& layout, double most);

/// What a line given for scanner numbers makes them. Throws Error when the numbers cannot be HU and none is.
void require_hu(volume::ScanVolume& about, const volume::Tally& tally, const ImportOptions& options,
                const std::filesystem::path& file);

/// Fills in frame, size, volume, area and densities. Throws Error for a bone without a sample inside.
void measure(const Bone& bone, ImportSummary& summary);
void measure(const SparseBone& bone, ImportSummary& summary, const RunJobs& run);

/// Spreads the points that the options ask for.
void add_points(Bone& bone, const ImportOptions& options, ImportSummary& summary);

/// Tells a bone where it came from.
void add_provenance(Bone& bone, const ImportOptions& options, const ImportSummary& found,
                    const std::string& source_hash);

/// Of a file, or of all files of a folder in the order of their names; 16 hexadecimal digits.
std::string hash_of_source(const std::filesystem::path& path);

}  // namespace tactus::bone
