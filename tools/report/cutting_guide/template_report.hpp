// SPDX-License-Identifier: Apache-2.0
// A template for a plate as a result: pictures on its bone, measures of its bed, marks, warnings.
#pragma once

#include "tools/analysis/cutting_guide/plan_template.hpp"
#include "tools/report/result/fields.hpp"

#include <string>

namespace tactus::report {

/// A template with the file that was written of it.
struct MadeTemplateFile {
    const analysis::PlannedTemplate* made;
    std::string plan, file;
};

const Fields<MadeTemplateFile>& template_fields();

}  // namespace tactus::report
