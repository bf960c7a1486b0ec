// SPDX-License-Identifier: Apache-2.0
// tactus plan group, add, ungroup, remove, lock, unlock, hide, unhide: each adds one step to the plan.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"

namespace tactus::command {

namespace {

struct ArrangeChoice : PlanChoice {
    std::string kind;  // kind of step as in the plan file; "unhide" is called "show" there
    std::string group;
};

std::vector<int> numbers_of_fragments(const plan::CasePlan& plan, const std::vector<std::string>& names) {
    std::vector<int> numbers;
    for (const std::string& name : names) numbers.push_back(plan::find_fragment(plan, name));
    return numbers;
}

plan::StepKind kind_of(const std::string& verb) {
    for (int n = 0; n <= static_cast<int>(plan::StepKind::mirror); ++n)
        if (plan::name_of(static_cast<plan::StepKind>(n)) == verb) return static_cast<plan::StepKind>(n);
    return plan::StepKind::show;  // "unhide"
}

int arrange(const ArrangeChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    plan::PlanStep step;
    step.kind = kind_of(choice.kind);
    step.by = "command";
    step.fragments = numbers_of_fragments(plan, choice.names);
    step.group = step.kind == plan::StepKind::group && choice.group.empty()
                     ? plan::free_group_name(plan::state_of(plan))
                     : choice.group;
    analysis::do_step(plan, std::move(step), choice.plan);
    return show_change(choice);
}

std::shared_ptr<ArrangeChoice> choice_of(VerbOptions& verb, const char* kind) {
    auto choice = std::make_shared<ArrangeChoice>();
    choice->kind = kind;
    add_plan_options(verb, *choice);
    return choice;
}

/// A verb whose only arguments are fragments.
template <const char* kind>
Action add_simple(VerbOptions& verb) {
    const auto choice = choice_of(verb, kind);
    add_fragments(verb, *choice, "which ones");
    return [choice] { return arrange(*choice); };
}

constexpr char remove_kind[] = "remove", lock_kind[] = "lock", unlock_kind[] = "unlock", hide_kind[] = "hide",
               unhide_kind[] = "unhide";

}  // namespace

Verb plan_group_verb() {
    return {"group", "group fragments, and the groups they are in, so that they move together",
            [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, "group");
                add_fragments(verb, *choice, "which ones");
                verb.add("--name", choice->group, "name of the group (default: group_1 and on)");
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_add_verb() {
    return {"add", "add fragments, and the groups they are in, to a group", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, "add");
                verb.add("group", choice->group, "which group").required();
                add_fragments(verb, *choice, "which ones");
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_ungroup_verb() {
    return {"ungroup", "dissolve a group into its parts", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, "ungroup");
                verb.add("group", choice->group, "which group").required();
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_remove_verb() { return {"remove", "remove fragments from all groups", add_simple<remove_kind>}; }
Verb plan_lock_verb() {
    return {"lock", "lock fragments and their groups, so that they cannot be moved", add_simple<lock_kind>};
}
Verb plan_unlock_verb() { return {"unlock", "unlock fragments", add_simple<unlock_kind>}; }
Verb plan_hide_verb() { return {"hide", "leave fragments out of pictures, fits and files", add_simple<hide_kind>}; }
Verb plan_unhide_verb() { return {"unhide", "show hidden fragments again", add_simple<unhide_kind>}; }

}  // namespace tactus::command
