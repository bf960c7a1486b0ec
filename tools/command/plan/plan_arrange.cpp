// SPDX-License-Identifier: Apache-2.0
// tactus plan group, add, ungroup, remove, lock, unlock, hide, unhide: each adds one step to the plan.
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <type_traits>

namespace tactus::command {

namespace {

struct ArrangeChoice : PlanChoice {
    plan::PlanCommand (*command)(const plan::FragmentSet& fragments, int group) = nullptr;
    const char* needs = nullptr;  // why it cannot be done where nothing changes; null: then it is done already
    bool is_of_group = false;  // of an existing one
    std::string group;
};

plan::FragmentSet set_of_fragments(const plan::CasePlan& plan, const std::vector<std::string>& names) {
    std::vector<int> numbers;
    for (const std::string& name : names) {
        numbers.push_back(plan::find_fragment(plan, name));
        if (std::ranges::count(numbers, numbers.back()) > 1) throw Error(fmt::format("'{}' is named twice", name));
    }
    return plan::set_of(numbers);
}

int number_of_group(const plan::CasePlan& plan, const std::string& name) {
    const plan::PlanState state = plan::state_of(plan);
    const int group = state.find_group(name);
    if (group != fit::Arrangement::none) return group;
    std::vector<std::string> names;
    std::ranges::copy_if(state.group_names, std::back_inserter(names), [](const auto& n) { return !n.empty(); });
    throw Error(fmt::format("there is no group '{}'{}", name, did_you_mean(name, names)));
}

int arrange(const ArrangeChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    const plan::FragmentSet fragments = set_of_fragments(open.plan, choice.names);
    const int group = choice.is_of_group ? number_of_group(open.plan, choice.group) : fit::Arrangement::none;
    const bool is_changed = analysis::change_plan(open.plan, choice.command(fragments, group),
                                                  {.by = "command", .name = choice.group}, choice.plan);
    if (!is_changed && choice.needs) throw Error(choice.needs);
    return show_change(choice, is_changed);
}

std::shared_ptr<ArrangeChoice> choice_of(VerbOptions& verb,
                                         plan::PlanCommand (*command)(const plan::FragmentSet&, int)) {
    auto choice = std::make_shared<ArrangeChoice>();
    choice->command = command;
    add_plan_options(verb, *choice);
    return choice;
}

/// A verb whose only arguments are fragments.
template <class Command, bool... is_on>
Action add_simple(VerbOptions& verb) {
    const auto choice =
        choice_of(verb, [](const plan::FragmentSet& all, int) -> plan::PlanCommand { return Command{all, is_on...}; });
    if (std::is_same_v<Command, plan::SplitFragments>) choice->needs = "none of them is in a group";
    add_fragments(verb, *choice, "which ones");
    return [choice] { return arrange(*choice); };
}

}  // namespace

Verb plan_group_verb() {
    return {"group", "group fragments, and the groups they are in, so that they move together",
            [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, [](const plan::FragmentSet& all, int) -> plan::PlanCommand {
                    return plan::JoinFragments{all};
                });
                choice->needs = "a group needs two fragments that do not move together already";
                add_fragments(verb, *choice, "which ones");
                verb.add("--name", choice->group, "name of the group (default: group_1 and on)");
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_add_verb() {
    return {"add", "add fragments, and the groups they are in, to a group", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, [](const plan::FragmentSet& all, int group) -> plan::PlanCommand {
                    return plan::AddFragments{group, all};
                });
                choice->is_of_group = true;
                choice->needs = "they are members of that group already";
                verb.add("group", choice->group, "which group").required();
                add_fragments(verb, *choice, "which ones");
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_ungroup_verb() {
    return {"ungroup", "dissolve a group into its parts", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb, [](const plan::FragmentSet&, int group) -> plan::PlanCommand {
                    return plan::DissolveGroup{group};
                });
                choice->is_of_group = true;
                verb.add("group", choice->group, "which group").required();
                return [choice] { return arrange(*choice); };
            }};
}

Verb plan_remove_verb() { return {"remove", "remove fragments from all groups", add_simple<plan::SplitFragments>}; }
Verb plan_lock_verb() {
    return {"lock", "lock fragments and their groups, so that they cannot be moved",
            add_simple<plan::LockFragments, true>};
}
Verb plan_unlock_verb() { return {"unlock", "unlock fragments", add_simple<plan::LockFragments, false>}; }
Verb plan_hide_verb() {
    return {"hide", "leave fragments out of pictures, fits and files", add_simple<plan::HideFragments, true>};
}
Verb plan_unhide_verb() { return {"unhide", "show hidden fragments again", add_simple<plan::HideFragments, false>}; }

}  // namespace tactus::command
