// SPDX-License-Identifier: Apache-2.0
// A guide as blocks of a report: pictures on its bone, dimensions of its slots and holes, warnings.
#pragma once

#include "tools/analysis/cutting_guide/plan_guide.hpp"
#include "tools/report/blocks/report_block.hpp"

#include <vector>

namespace tactus::report {

/// The guide on its bone from the side that it is taken off to, from its rail, and from the bone. Throws Error when
/// pictures cannot be made.
std::vector<render::LabelledPicture> guide_pictures(const analysis::PlannedGuide& guide);

/// Pictures, a drawing with dimensions, and tables of the slots with their letters, the holes, the checks and where each number is from.
std::vector<ReportBlock> guide_blocks(const analysis::PlannedGuide& guide);

}  // namespace tactus::report
