// SPDX-License-Identifier: Apache-2.0
// Deviation of a reconstruction from the target of its plan (`plan mirror`).
#pragma once

#include "assets/plan/case_plan.hpp"
#include "dsp/reconstruction/target_deviation.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct NamedDeviation {
    std::string segment;
    reconstruction::SegmentDeviation deviation;
};

/// Of each segment where it lies, or where it is planned if one of them still lies in the leg. Empty if the plan has no
/// reconstruction or no target, and if a file has changed. Throws Error for files that cannot be read.
std::vector<NamedDeviation> deviation_from_target(const plan::CasePlan& plan, const std::filesystem::path& folder);

/// One line, mm: "segment-1: curve 1.2 mm rms from the target's, ...".
std::string deviation_words(const NamedDeviation& one);

}  // namespace tactus::analysis
