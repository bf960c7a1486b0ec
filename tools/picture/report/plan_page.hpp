// SPDX-License-Identifier: Apache-2.0
// A plan as one HTML page: pictures, gaps, fits, order of steps.
#pragma once

#include "dsp/fit/registration/registration.hpp"
#include "tools/study/planning/plan_case.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::picture {

/// `fragments`: of the plan, in its order; `to_healthy`: m, the median distance of each from the healthy side where it is
/// planned, as far as there is one; `first`: HTML that comes before all else; `healthy`: that side in the frame of the
/// case, for maps of the distance from it; null: none. Throws Error when pictures cannot be made.
std::string plan_page(const cases::CasePlan& plan, std::vector<study::CaseFragment> fragments,
                      std::vector<std::optional<double>> to_healthy = {}, const std::string& first = "",
                      const fit::RegistrationTarget* healthy = nullptr);

}  // namespace tactus::picture
