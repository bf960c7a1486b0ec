// SPDX-License-Identifier: Apache-2.0
// tactus plan report: the plan as an HTML page, or in another format of results.
#include "assets/file/json.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace tactus::command {

namespace {

/// Default path: beside the plan, without its extensions.
std::filesystem::path page_of(const std::filesystem::path& plan) {
    std::string stem = plan.filename().string();
    for (const char* ending : {".json", ".plan"})
        if (stem.ends_with(ending)) stem.resize(stem.size() - std::string(ending).size());
    return plan.parent_path() / (stem + ".html");
}

struct ReportChoice : PlanChoice {
    std::filesystem::path pdf;  // old spelling: the report as a PDF file too
};

using Names = std::vector<std::string>;

const report::Fields<Names>& written_fields() {
    static const report::Fields<Names> all =
        report::Fields<Names>("reports that were written").texts("reports", "", [](const Names& names) {
            return names;
        });
    return all;
}

int report(const ReportChoice& choice) {
    ResultChoice files = choice.result;
    if (files.out.empty()) files.out.push_back(page_of(choice.plan));
    if (!choice.pdf.empty()) files.out.push_back(choice.pdf);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<std::filesystem::path> sources = plan::files_of(plan, folder);
    sources.push_back(choice.plan);
    check_result_files(files, sources);
    Progress progress(files.quiet);
    const report::ShownPlan shown = report::ShownPlan::reported(
        plan, folder, [&progress](double done, std::string_view doing) { progress.show(done, doing); });
    for (const std::string& note : shown.warnings.notes) fmt::print(stderr, "note: {}\n", note);
    report::Result result = report::plan_fields().of(shown);
    draw_pictures(result, files);
    progress.clear();
    write_files(result, files);
    if (files.quiet) return done;
    Names names;
    for (const std::filesystem::path& out : files.out) names.push_back(out.string());
    if (files.json) say(stdout, report::output_json(written_fields().of(names)).dump(2) + "\n");
    else
        for (const std::string& name : names) say(stdout, name + "\n");
    return done;
}

Action declare_plan_report(VerbOptions& verb) {
    const auto choice = std::make_shared<ReportChoice>();
    choice->result.formats = {".html", ".pdf", ".txt"};
    add_plan_report_options(verb, *choice)
        .about("file for the report, by its ending: .html, .pdf or .txt; repeatable (default: .html, beside the plan)");
    verb.output("--pdf", choice->pdf, {{".pdf"}}, "write the report as a PDF file too").hidden();
    return [choice] { return report(*choice); };
}

}  // namespace

Verb plan_report_verb() {
    return {.name = "report",
            .about = "write an HTML page, or a PDF file, with warnings, fits, pictures, gaps and the order of steps",
            .add = declare_plan_report,
            .schema = [] { return report::schema_of_output({written_fields().schema()}); }};
}

}  // namespace tactus::command
