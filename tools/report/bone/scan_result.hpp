// SPDX-License-Identifier: Apache-2.0
// What is read from scans as results: 'info', 'import', 'segment', 'vessel'.
#pragma once

#include "assets/bone/import.hpp"
#include "tools/analysis/bone/inspection.hpp"
#include "tools/analysis/bone/vessel.hpp"
#include "tools/analysis/segmentation/segment_scan.hpp"
#include "tools/report/result/fields.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

struct InspectedFile {
    std::string file, picture;  ///< "": none was written
    const analysis::Inspection* found;
};
const Fields<InspectedFile>& inspection_fields();

/// A bone that was imported; of a label map also its label.
struct ImportedFile {
    const bone::ImportSummary* summary;
    std::string component;  ///< that was kept: "largest", "all" or a number
    bool is_density_given;
    std::string name{}, surface{};
    std::optional<int> label{};
};
struct ImportedBones {
    std::string file;
    std::vector<ImportedFile> bones;
};
/// Of one bone, and of the bones of a label map.
const Fields<ImportedBones>& imported_bone_fields();
const Fields<ImportedBones>& imported_labels_fields();

struct SegmentedFile {
    const analysis::ScanGraph* scan;
    const analysis::SegmentedScan* found;
    std::vector<std::string> files;
};
const Fields<SegmentedFile>& segmentation_fields();

struct FollowedVessel {
    Vec3 seed;
    const analysis::FoundVessel* found;
};
const Fields<FollowedVessel>& vessel_track_fields();

}  // namespace tactus::report
