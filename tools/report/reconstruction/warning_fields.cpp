// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/warning_fields.hpp"

namespace tactus::report {

namespace {

using Warnings = std::vector<analysis::CaseWarning>;

/// code, text, object, other, fault
const Fields<analysis::CaseWarning>& case_warning_fields() {
    using analysis::CaseWarning;
    const auto if_any = [](std::string CaseWarning::* member) {
        return [member](const CaseWarning& w) { return (w.*member).empty() ? std::nullopt : std::optional(w.*member); };
    };
    static const Fields<CaseWarning> all = Fields<CaseWarning>("warning of a plan")
                                               .text("code", "", &CaseWarning::code)
                                               .text("text", "", &CaseWarning::text)
                                               .text("object", "", if_any(&CaseWarning::object))
                                               .text("other", "", if_any(&CaseWarning::other))
                                               .flag("fault", "", &CaseWarning::is_fault);
    return all;
}

}  // namespace

std::vector<std::string> texts_of(const Warnings& warnings, bool faults) {
    std::vector<std::string> texts;
    for (const analysis::CaseWarning& warning : warnings)
        if (warning.is_fault == faults) texts.push_back(warning.text);
    return texts;
}

const Fields<Warnings>& plan_warnings_fields() {
    static const Fields<Warnings> all =
        Fields<Warnings>("warnings of a plan")
            .warnings(
                "", [](const Warnings& w) { return texts_of(w, true); }, "problem")
            .warnings("", [](const Warnings& w) { return texts_of(w, false); })
            .rows("warnings", "", case_warning_fields(), [](const Warnings& w) -> const Warnings& { return w; });
    return all;
}

}  // namespace tactus::report
