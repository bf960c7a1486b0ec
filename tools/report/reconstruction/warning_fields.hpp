// SPDX-License-Identifier: Apache-2.0
// Warnings of a plan as fields of results.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/report/result/fields.hpp"

#include <string>
#include <vector>

namespace tactus::report {

/// code, text, object, other, fault
const Fields<analysis::CaseWarning>& case_warning_fields();

/// Texts of the warnings that 'plan check' refuses, or of the others.
std::vector<std::string> texts_of(const std::vector<analysis::CaseWarning>& warnings, bool faults);

/// Rows `warnings`; printed before all values, those first that 'plan check' refuses. `read`: the list of a struct.
template <class T, class Read>
Fields<T>& add_warnings(Fields<T>& fields, Read read) {
    return fields.warnings(
                     "", [read](const T& of) { return texts_of(read(of), true); }, "problem")
        .warnings("", [read](const T& of) { return texts_of(read(of), false); })
        .rows("warnings", "", case_warning_fields(), read);
}

}  // namespace tactus::report
