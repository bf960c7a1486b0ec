// SPDX-License-Identifier: Apache-2.0
// Files of a segmented scan: labels, one bone per label, a plan of these bones.
#pragma once

#include "dsp/reconstruction/flap.hpp"
#include "tools/analysis/segmentation/segment_scan.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Writes the labels (.nrrd, .seg.nrrd) or a bone per label (.vdb). `seeds`: the name stored in the bones' provenance.
/// Throws Error.
void write_segmented(const ScanGraph& scan, const SegmentedScan& found, const SegmentSettings& settings,
                     const std::string& seeds, const std::filesystem::path& path);

/// Writes a plan with one fragment per bone of the file, at its scanned pose, in the label's colour, and with these
/// vessels of the case. Throws Error if the plan exists: it is never overwritten.
void write_plan_of(const std::filesystem::path& bones, const SegmentedScan& found, const std::filesystem::path& plan,
                   const std::vector<reconstruction::FlapVessel>& vessels = {});

}  // namespace tactus::analysis
