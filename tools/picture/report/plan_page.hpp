// SPDX-License-Identifier: Apache-2.0
// A plan as one HTML page: pictures, gaps, fits, order of steps.
#pragma once

#include "tools/study/planning/plan_case.hpp"

#include <string>
#include <vector>

namespace tactus::picture {

/// `fragments`: of the plan, in its order. Throws Error when pictures cannot be made.
std::string plan_page(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments);

}  // namespace tactus::picture
