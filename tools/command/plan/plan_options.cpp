// SPDX-License-Identifier: Apache-2.0
#include "tools/command/plan/plan_options.hpp"

#include "assets/plan/plan_file.hpp"
#include "tools/command/kerf_option.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tactus::command {

void add_plan_options(VerbOptions& verb, PlanChoice& choice) {
    verb.add("plan", choice.plan, "plan file, JSON").required();
    verb.flag("--json", choice.result.json, "as JSON");
}

Option add_plan_report_options(VerbOptions& verb, PlanChoice& choice, Product product) {
    verb.add("plan", choice.plan, "plan file, JSON").required();
    return add_result_options(verb, choice.result, ResultFigure::none, std::move(product));
}

void add_fit_options(VerbOptions& verb, PlanChoice& choice) {
    add_kerf(verb, choice.kerf);
    verb.flag("--healthy", choice.with_healthy,
              "fit to the healthy side of 'plan mirror' too: it decides where the faces slide on each other");
}

void check_plan_results(const PlanChoice& choice, std::vector<std::filesystem::path> sources,
                        const std::vector<std::filesystem::path>& others) {
    const bool writes = !choice.result.out.empty() || !std::ranges::all_of(others, &std::filesystem::path::empty);
    if (writes) {
        std::ranges::move(plan::files_of(plan::load_case_plan(choice.plan), choice.plan.parent_path()),
                          std::back_inserter(sources));
        sources.push_back(choice.plan);
    }
    check_result_files(choice.result, sources, others);
}

analysis::FitWay fit_way(const PlanChoice& choice) {
    analysis::FitWay way{std::nullopt, choice.with_healthy};
    if (choice.kerf) way.kerf = *choice.kerf * 1e-3;
    return way;
}

Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about) {
    return verb.add("fragments", choice.names, about).required();
}

int show_change(const PlanChoice& choice, bool is_changed) {
    if (choice.result.json) return show_plan(choice);
    if (!is_changed) fmt::print("the plan is already so\n");
    return done;
}

}  // namespace tactus::command
