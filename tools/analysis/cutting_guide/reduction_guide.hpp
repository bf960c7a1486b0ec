// SPDX-License-Identifier: Apache-2.0
// A guide that holds fragments of a fracture in their planned places.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <filesystem>

namespace tactus::analysis {

/// A guide whose base lies on the fragments of `choice` (all that are shown when it names none) where the plan has them,
/// across the fractures between them: a region and up to two holes for screws on each, and a bridge over all. It is put on
/// from outside: away from the middle of all shown fragments, across the line on which the fragments follow each other;
/// `choice.turn` turns it about this line. Nothing touches the bone near a fracture line. `folder`: of the plan. Throws
/// Error for fragments that are hidden, that meet no other of them, that are farther apart or overlap more than
/// `choice.limits` allow, and like refuse_guide.
PlannedGuide plan_reduction_guide(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                  const GuideChoice& choice);

}  // namespace tactus::analysis
