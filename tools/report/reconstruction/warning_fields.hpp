// SPDX-License-Identifier: Apache-2.0
// Warnings of a plan as fields of results.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/report/result/fields.hpp"

#include <string>
#include <vector>

namespace tactus::report {

/// Texts of the warnings that 'plan check' refuses, or of the others.
std::vector<std::string> texts_of(const std::vector<analysis::CaseWarning>& warnings, bool faults);

/// Rows `warnings`; printed before all values, those first that 'plan check' refuses. A part of the struct that has them.
const Fields<std::vector<analysis::CaseWarning>>& plan_warnings_fields();

}  // namespace tactus::report
