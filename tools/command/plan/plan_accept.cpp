// SPDX-License-Identifier: Apache-2.0
// tactus plan accept: records a surgeon's decision that a fragment is where it belongs.
#include "tools/analysis/plan/plan_accept.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct AcceptChoice : PlanChoice {
    std::string by, beside;
};

int accept_place(const AcceptChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const int fragment = plan::find_fragment(plan, choice.names.front());
    const plan::FitBasis by = choice.by == "mirror" ? plan::FitBasis::mirror
                              : choice.by == "plan" ? plan::FitBasis::plan
                                                    : plan::FitBasis::hand;
    std::optional<int> beside;
    if (!choice.beside.empty()) beside = plan::find_fragment(plan, choice.beside);
    const analysis::Acceptance found =
        analysis::measure_acceptance(plan, choice.plan.parent_path(), fragment, by, beside);
    analysis::change_plan(plan, analysis::accepting(plan, fragment, by, found), {.by = "hand"}, choice.plan);
    if (choice.result.json) return show_change(choice);
    fmt::print("{}: accepted by {} beside {}, residual {:.2f} mm; ", choice.names.front(), choice.by, found.partner,
               found.residual * 1e3);
    if (found.facing > 0.0)
        fmt::print("{:.0f} mm² face each other, {:.2f} mm deep\n", found.facing * 1e6, found.penetration * 1e3);
    else if (found.penetration > 0.0)
        fmt::print("nothing faces it, and it lies {:.2f} mm deep in that one\n", found.penetration * 1e3);
    else fmt::print("nothing faces it within 3 mm, the surfaces are about {:.0f} mm apart\n", found.apart * 1e3);
    return done;
}

Action declare_plan_accept(VerbOptions& verb) {
    const auto choice = std::make_shared<AcceptChoice>();
    add_plan_options(verb, *choice);
    add_fragments(verb, *choice, "which one").count(1);
    verb.add(
            "--by", choice->by,
            "what the decision rests on: hand, the surgeon's eye; mirror, the healthy side of 'plan mirror'; plan, the "
            "planned place of a piece of a reconstruction")
        .one_of({"hand", "mirror", "plan"})
        .required();
    verb.add("--beside", choice->beside,
             "fragment that it is placed beside (default: the placed one that faces it over the largest area)");
    return [choice] { return accept_place(*choice); };
}

}  // namespace

Verb plan_accept_verb() {
    return {"accept", "record a surgeon's decision that a fragment is where it belongs, with its residual",
            declare_plan_accept};
}

}  // namespace tactus::command
