// SPDX-License-Identifier: Apache-2.0
// tactus plan report: the plan as an HTML page, or in another format of results.
#include "assets/file/json.hpp"
#include "assets/file/outputs.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/report/plan/plan_result.hpp"
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

int report(const PlanChoice& choice) {
    ResultChoice files = choice.result;
    if (files.out.empty()) files.out.push_back(page_of(choice.plan));
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<std::filesystem::path> sources = plan::files_of(plan, folder);
    sources.push_back(choice.plan);
    file::check_outputs(sources, files.out);
    check_result_files(files);
    Progress progress(files.quiet);
    const report::ShownPlan shown = report::ShownPlan::reported(
        plan, folder, [&progress](double done, std::string_view doing) { progress.show(done, doing); });
    for (const std::string& note : shown.warnings.notes) fmt::print(stderr, "note: {}\n", note);
    report::Result result = report::plan_fields().of(shown);
    try {
        report::settle_pictures(result, files.shows_figures());
    } catch (const Error& error) {
        throw Error(fmt::format("the pictures cannot be made: {}", error.what()));
    }
    progress.clear();
    write_files(result, files);
    if (files.quiet) return done;
    if (files.json) {
        std::vector<std::string> names;
        for (const std::filesystem::path& out : files.out) names.push_back(out.string());
        say(stdout, file::Json{{"reports", names}}.dump(2) + "\n");
    } else {
        for (const std::filesystem::path& out : files.out) say(stdout, out.string() + "\n");
    }
    return done;
}

Action declare_plan_report(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_report_options(verb, *choice);
    verb.old("--pdf", "--out");
    return [choice] { return report(*choice); };
}

}  // namespace

Verb plan_report_verb() {
    return {"report", "write an HTML page, or a PDF file, with warnings, fits, pictures, gaps and the order of steps",
            declare_plan_report};
}

}  // namespace tactus::command
