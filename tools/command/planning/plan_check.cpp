// SPDX-License-Identifier: Apache-2.0
// tactus plan check: whether a plan is finished and does not contradict itself, by its warnings.
#include "assets/cases/plan_file.hpp"
#include "assets/file/json.hpp"
#include "tools/command/planning/plan_options.hpp"
#include "tools/study/planning/case_warnings.hpp"
#include "tools/study/planning/plan_words.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

int check(const PlanChoice& choice) {
    using file::Json;
    const cases::CasePlan plan = cases::load_case_plan(choice.plan);
    const cases::PlanState state = cases::state_of(plan);
    const study::CaseWarnings found = study::case_warnings(plan, choice.plan.parent_path());
    for (const std::string& note : found.notes) fmt::print(stderr, "note: {}\n", note);
    if (choice.json) {
        Json problems = Json::array();
        for (const study::CaseWarning& warning : found.all)
            if (warning.is_fault) problems.push_back(warning.text);
        fmt::print("{}\n", Json{{"ok", !found.has_fault()},
                                {"assemblies", study::assembly_names(plan, state)},
                                {"problems", problems},
                                {"warnings", study::json_of(found.all)}}
                               .dump(2));
    } else {
        if (!state.reconstruction)
            for (const std::string& line : study::connection_words(plan, state)) fmt::print("{}\n", line);
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
