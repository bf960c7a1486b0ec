// SPDX-License-Identifier: Apache-2.0
// tactus plan report: the plan as one HTML page, and as PDF.
#include "assets/file/json.hpp"
#include "assets/file/outputs.hpp"
#include "assets/file/whole_file.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/blocks/pages.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/plan/plan_page.hpp"
#include "tools/report/reconstruction/flap_report.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

namespace tactus::command {

namespace {

struct ReportChoice : PlanChoice {
    std::filesystem::path out, pdf;
};

/// Default path: beside the plan, without its extensions.
std::filesystem::path page_of(const std::filesystem::path& plan) {
    std::string stem = plan.filename().string();
    for (const char* ending : {".json", ".plan"})
        if (stem.ends_with(ending)) stem.resize(stem.size() - std::string(ending).size());
    return plan.parent_path() / (stem + ".html");
}

int report(const ReportChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const std::filesystem::path out = choice.out.empty() ? page_of(choice.plan) : choice.out;
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<std::filesystem::path> sources = plan::files_of(plan, folder);
    sources.push_back(choice.plan);
    file::check_outputs(sources, std::array{out, choice.pdf});
    std::vector<analysis::CaseFragment> fragments = analysis::load_fragments(plan, folder);
    std::vector<std::optional<double>> residuals = analysis::healthy_residuals(plan::state_of(plan), folder, fragments);
    const std::optional<fit::RegistrationTarget> healthy = analysis::healthy_side(plan::state_of(plan), folder);
    const analysis::CaseWarnings warnings = analysis::case_warnings(plan, folder);
    for (const std::string& note : warnings.notes) fmt::print(stderr, "note: {}\n", note);
    const std::vector<report::ReportBlock> blocks =
        report::plan_blocks(plan, warnings.all, std::move(fragments), std::move(residuals),
                            healthy ? &*healthy : nullptr, report::flap_blocks(plan, folder));
    file::write_whole_file(out, report::html::page(plan.title, report::html_of(blocks, "plan")));
    if (!choice.pdf.empty()) {
        const report::Pdf pdf = report::pdf_of(plan.title, blocks);
        file::write_whole_file(choice.pdf, pdf.bytes);
        if (!pdf.warning.empty()) fmt::print(stderr, "warning: {}: {}\n", choice.pdf.string(), pdf.warning);
    }
    file::Json written{{"report", out.string()}};
    if (!choice.pdf.empty()) written["pdf"] = choice.pdf.string();
    if (choice.json) fmt::print("{}\n", written.dump(2));
    else fmt::print("{}\n", out.string());
    if (!choice.json && !choice.pdf.empty()) fmt::print("{}\n", choice.pdf.string());
    return done;
}

Action declare_plan_report(VerbOptions& verb) {
    const auto choice = std::make_shared<ReportChoice>();
    add_plan_options(verb, *choice);
    verb.add("-o,--out", choice->out, "HTML file (default: beside the plan)");
    verb.add("--pdf", choice->pdf, "write the report as a PDF file too");
    return [choice] { return report(*choice); };
}

}  // namespace

Verb plan_report_verb() {
    return {"report",
            "write an HTML page, or a PDF file too, with warnings, fits, pictures, gaps and the order of steps",
            declare_plan_report};
}

}  // namespace tactus::command
