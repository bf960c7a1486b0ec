// SPDX-License-Identifier: Apache-2.0
// Files of a segmented scan: labels, a bone per label, a plan of them.
#pragma once

#include "dsp/reconstruct/flap.hpp"
#include "tools/study/segment/segment_scan.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::study {

/// Writes the labels (.nrrd, .seg.nrrd) or a bone per label (.vdb). `seeds`: the name that bones keep as their origin.
/// Throws Error.
void write_segmented(const ScanGraph& scan, const SegmentedScan& found, const SegmentSettings& settings,
                     const std::string& seeds, const std::filesystem::path& path);

/// A plan with a fragment per bone of the file, at its scanned place, in the label's colour, and with these vessels of the
/// case. Throws Error for a plan that exists: it is never overwritten.
void write_plan_of(const std::filesystem::path& bones, const SegmentedScan& found, const std::filesystem::path& plan,
                   const std::vector<reconstruct::FlapVessel>& vessels = {});

}  // namespace tactus::study
