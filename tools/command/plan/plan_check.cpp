// SPDX-License-Identifier: Apache-2.0
// tactus plan check: whether a plan is finished and does not contradict itself, by its warnings.
#include "assets/file/json.hpp"
#include "assets/plan/plan_file.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/analysis/plan/target_deviation.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

int check(const PlanChoice& choice) {
    using file::Json;
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const plan::PlanState state = plan::state_of(plan);
    const analysis::CaseWarnings found = analysis::case_warnings(plan, choice.plan.parent_path());
    for (const std::string& note : found.notes) fmt::print(stderr, "note: {}\n", note);
    const auto deviation = analysis::deviation_from_target(plan, choice.plan.parent_path());
    if (choice.json) {
        Json problems = Json::array();
        for (const analysis::CaseWarning& warning : found.all)
            if (warning.is_fault) problems.push_back(warning.text);
        Json checked{{"ok", !found.has_fault()},
                     {"assemblies", analysis::assembly_names(plan, state)},
                     {"problems", problems},
                     {"warnings", analysis::json_of(found.all)}};
        if (!deviation.empty()) checked["deviation"] = analysis::deviation_json(deviation);
        fmt::print("{}\n", checked.dump(2));
    } else {
        if (!state.reconstruction)
            for (const std::string& line : analysis::connection_words(plan, state)) fmt::print("{}\n", line);
        for (const analysis::NamedDeviation& one : deviation) fmt::print("{}\n", analysis::deviation_words(one));
        print_warnings(found);
        if (!found.has_fault())
            fmt::print("{}\n", state.reconstruction
                                   ? "all pieces are where they are planned or accepted, and none lies in another"
                                   : "all shown fragments are connected, every fit holds, and none lies in another");
    }
    return found.has_fault() ? answer_is_no : done;
}

Action declare_plan_check(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_options(verb, *choice);
    return [choice] { return check(*choice); };
}

}  // namespace

Verb plan_check_verb() {
    return {
        "check",
        "check that fits or decisions connect all shown fragments, that the pieces of a reconstruction are where they "
        "are planned, and that none lies in another; 1: it is not so",
        declare_plan_check};
}

}  // namespace tactus::command
