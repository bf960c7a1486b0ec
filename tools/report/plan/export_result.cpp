// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/export_result.hpp"

#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace tactus::report {

namespace {

using analysis::ExportedFragment;
using analysis::ExportedPlan;

const Fields<ExportedFragment>& written_fields() {
    using F = ExportedFragment;
    static const Fields<F> all = Fields<F>("exported fragment")
                                     .text("fragment", "fragment", &F::name)
                                     .texts("files", "files", &F::files)
                                     .child("pose", "", pose_fields(), &F::pose);
    return all;
}

}  // namespace

const Fields<ExportedPlan>& exported_plan_fields() {
    using P = ExportedPlan;
    static const Fields<P> all =
        Fields<P>("files of a plan for other programs")
            .warnings(
                "",
                [](const P& p) {
                    if (p.left_out.empty()) return std::vector<std::string>();
                    return std::vector{fmt::format("hidden, so not written: {}; show them with 'tactus plan unhide'",
                                                   fmt::join(p.left_out, ", "))};
                },
                "note")
            .rows("written", "written", written_fields(), &P::written)
            .texts("left_out", "", &P::left_out);
    return all;
}

}  // namespace tactus::report
