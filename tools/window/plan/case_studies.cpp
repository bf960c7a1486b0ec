// SPDX-License-Identifier: Apache-2.0
// Studies of the plan: gaps, distance from the healthy side, page, files for other programs.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/plan/plan_export.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/counted.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/window/document/case_run.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

std::string gaps_of(const plan::CasePlan& plan, const fs::path& folder) {
    std::string text;
    const auto name = [&](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    for (const analysis::PlanGap& g : analysis::plan_gaps(plan, folder, {}))
        text +=
            g.gap.facing > 0.0
                ? fmt::format("{}, {}: gap {:.2f} mm (95 %: {:.2f} mm), overlap {:.1f} mm³\n", name(g.first),
                              name(g.second), analysis::shown_mm(g.gap.median * 1e3), g.gap.p95 * 1e3, g.overlap * 1e9)
                : fmt::format("{}, {}: overlap {:.1f} mm³\n", name(g.first), name(g.second), g.overlap * 1e9);
    return text.empty() ? "no two shown fragments face each other within 3 mm" : text;
}

std::string healthy_of(const plan::CasePlan& plan, const fs::path& folder) {
    std::string text;
    const auto residuals =
        analysis::healthy_residuals(plan::state_of(plan), folder, analysis::load_fragments(plan, folder));
    for (std::size_t n = 0; n < residuals.size(); ++n)
        if (residuals[n])
            text += fmt::format("{}: {:.2f} mm from the mirrored side (median)\n", plan.fragments[n].name,
                                *residuals[n] * 1e3);
    return text.empty() ? "the plan has no healthy side; make one by 'tactus plan mirror'" : text;
}

fs::path free_folder(const fs::path& folder) {
    for (int i = 1;; ++i)
        if (fs::path free = folder / fmt::format("export-{}", i); !fs::exists(free)) return free;
}

/// `folder`: for files that are written; the paths in the plan are absolute.
std::string made(CaseRun::Study what, const plan::CasePlan& plan, const fs::path& folder) {
    switch (what) {
        case CaseRun::Study::gaps: return gaps_of(plan, folder);
        case CaseRun::Study::healthy: return healthy_of(plan, folder);
        case CaseRun::Study::report: {
            const fs::path page = folder / "case.html";
            file::write_whole_file(
                page, report::html_of(report::plan_fields().of(report::ShownPlan::reported(plan, folder))));
            return fmt::format("report: {}", page.string());
        }
        case CaseRun::Study::files: {
            const fs::path out = free_folder(folder);
            const analysis::ExportedPlan exported = analysis::export_plan(plan, folder, out, "stl");
            return fmt::format(
                "{} written to {}{}", counted(exported.written.size(), "fragment"), out.string(),
                exported.left_out.empty() ? "" : fmt::format("; {} hidden, not written", exported.left_out.size()));
        }
    }
    return {};
}

}  // namespace

void CaseRun::begin(Study what) {
    if (is_busy()) return;
    if (!plan_) return bench_.tell("there is no plan yet", true);
    found_.clear();
    has_numbers_ = false;
    studied_ = what;
    study_of_ = version_;
    study_begun_ = Clock::now();
    study_.begin(analysis::Lane::studies, [what, plan = plan_, folder = folder_of_results()](std::stop_token stop) {
        // An export of many files is made as a whole.
        const StopScope scope(what == Study::files ? std::stop_token() : std::move(stop));
        return made(what, *plan, folder);
    });
}

void CaseRun::cancel_study() { study_.let_go(); }

}  // namespace tactus::window
