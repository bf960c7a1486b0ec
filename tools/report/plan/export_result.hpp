// SPDX-License-Identifier: Apache-2.0
// The files that a plan was exported to, as a result.
#pragma once

#include "tools/analysis/plan/plan_export.hpp"
#include "tools/report/result/fields.hpp"

namespace tactus::report {

const Fields<analysis::ExportedPlan>& exported_plan_fields();

}  // namespace tactus::report
