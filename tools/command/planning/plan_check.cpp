// SPDX-License-Identifier: Apache-2.0
// tactus plan check: whether the fragments hang together, every fit holds, no fragment lies in another, and the files
// are those of the plan.
#include "assets/cases/plan_file.hpp"
#include "assets/file/json.hpp"
#include "tools/command/planning/plan_options.hpp"
#include "tools/study/planning/plan_overlaps.hpp"
#include "tools/study/planning/plan_words.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

int check(const PlanChoice& choice) {
    using file::Json;
    const cases::CasePlan plan = cases::load_case_plan(choice.plan);
    const cases::PlanState state = cases::state_of(plan);
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<std::string> problems = cases::changed_files(plan, folder);
    const bool has_files = problems.empty();
    for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n)
        if (state.fits[static_cast<std::size_t>(n)] && !state.holds(n) && !state.arrangement.is_hidden(n))
            problems.push_back(
                fmt::format("{}: {}", plan.fragments[static_cast<std::size_t>(n)].name, study::fit_words(state, n)));
    const auto parts = study::assembly_names(plan, state);
    if (parts.empty()) problems.push_back("no fragment is shown; show some with 'tactus plan unhide'");
    if (parts.size() > 1)
        problems.push_back(
            fmt::format("the fragments are in {} parts that no fit connects; fit one to the other with "
                        "'tactus plan snap'",
                        parts.size()));
    // Without its files nothing shows where a fragment ends.
    std::vector<std::string> notes;
    if (has_files)
        for (const study::PlanOverlap& overlap : study::plan_overlaps(plan, folder, notes))
            problems.push_back(study::overlap_words(plan, overlap));
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
    if (choice.json)
        fmt::print("{}\n", Json{{"ok", problems.empty()}, {"assemblies", parts}, {"problems", problems}}.dump(2));
    else {
        for (const std::string& line : study::connection_words(plan, state)) fmt::print("{}\n", line);
        for (const std::string& problem : problems) fmt::print("! {}\n", problem);
        if (problems.empty())
            fmt::print("all shown fragments are connected, every fit holds, and none lies in another\n");
    }
    return problems.empty() ? done : answer_is_no;
}

Action declare_plan_check(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_options(verb, *choice);
    return [choice] { return check(*choice); };
}

}  // namespace

Verb plan_check_verb() {
    return {"check",
            "check that fits connect all shown fragments and hold, and that none lies in another; 1: it is not so",
            declare_plan_check};
}

}  // namespace tactus::command
