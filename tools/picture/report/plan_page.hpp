// SPDX-License-Identifier: Apache-2.0
// The plan as one page: pictures, gaps, fits, the order of steps.
#pragma once

#include "tools/study/planning/plan_case.hpp"

#include <string>
#include <vector>

namespace tactus::picture {

/// `fragments`: those of the plan, in its order. Throws Error when no pictures can be made.
std::string plan_page(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments);

}  // namespace tactus::picture
