// SPDX-License-Identifier: Apache-2.0
// Plans are made and changed: one step, saved at once.
#include "assets/bone/labels.hpp"
#include "dsp/core/error.hpp"
#include "tools/study/planning/plan_case.hpp"
#include "tools/plan_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tactus {

namespace {

namespace fs = std::filesystem;

std::vector<int> numbers_of_fragments(const CasePlan& plan, const std::vector<std::string>& names) {
    std::vector<int> numbers;
    for (const std::string& name : names) numbers.push_back(find_fragment(plan, name));
    return numbers;
}

/// "NAME=FILE" or "FILE", whose stem, or the bone's name in it, is the fragment's.
void add_file_of(CasePlan& plan, const std::string& text, const fs::path& folder) {
    const auto equals = text.find('=');
    const bool is_named = equals != std::string::npos && !fs::exists(text);
    const std::string name = is_named ? text.substr(0, equals) : "";
    const fs::path file = is_named ? text.substr(equals + 1) : text;
    std::vector<std::pair<std::string, fs::path>> found;
    if (file_of_bone(file) == file && file.extension() == ".vdb") {
        const auto bones = load_bones(file);
        if (bones.size() > 1 && is_named)
            throw Error(fmt::format("{}: holds {} bones; name one of them, as in {}={}#{}", file.string(), bones.size(),
                                    name, file.string(), bones.front().name));
        for (const Bone& bone : bones)
            found.emplace_back(bones.size() > 1 ? bone.name : file.stem().string(),
                               bones.size() > 1 ? fs::path(file.string() + "#" + bone.name) : file);
    } else {
        const std::string whole = file.string();
        const auto mark = whole.rfind('#');
        const bool is_one_of = file_of_bone(file) != file && mark != std::string::npos;
        found.emplace_back(is_one_of ? whole.substr(mark + 1) : file.stem().string(), file);
    }
    for (auto& [own, path] : found) {
        add_fragment(plan, is_named ? name : own, path, folder,
                     label_colour(static_cast<int>(plan.fragments.size()) + 1));
        // Metres, open surfaces and broken files come out now, not in the middle of a session.
        load_fragment(plan.fragments.back(), folder);
    }
}

StepKind kind_of(const std::string& verb) {
    for (int n = 0; n <= static_cast<int>(StepKind::mirror); ++n)
        if (name_of(static_cast<StepKind>(n)) == verb) return static_cast<StepKind>(n);
    return StepKind::show;  // "unhide"
}

int say(const PlanChoice& choice) {
    if (choice.json) return plan_show(choice);
    return done;
}

int go(const PlanChoice& choice, HistoryPlace (*way)(std::span<const int>, HistoryPlace), const char* end) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    const auto before = plan.before();
    int moved = 0;
    for (; moved < choice.steps; ++moved) {
        const HistoryPlace next = way(before, plan.place());
        if (next.head == plan.place().head) break;
        plan.place() = next;
    }
    if (moved > 0) save_case_plan(plan, choice.plan);
    if (!choice.json) {
        if (moved == 0) fmt::print("{}\n", end);
        else
            fmt::print("{} steps; {} of {} are done\n", moved, steps_to(before, plan.place().head).size(),
                       steps_to(before, plan.place().tip).size());
    }
    say(choice);
    return moved > 0 ? done : answer_is_no;
}

int list_alternatives(const PlanChoice& choice) {
    if (choice.json) return plan_show(choice);
    const CasePlan plan = load_case_plan(choice.plan);
    for (const PlanAlternative& a : plan.alternatives)
        fmt::print("{} {}: {} steps\n", &a == &plan.alternatives[static_cast<std::size_t>(plan.current)] ? '*' : ' ',
                   a.name, steps_to(plan.before(), a.place.head).size());
    return done;
}

}  // namespace

int plan_new(const PlanChoice& choice) {
    if (fs::exists(choice.plan))
        throw Error(fmt::format("{}: is there already; a plan is never written over", choice.plan.string()));
    const PlanLock lock(choice.plan);
    CasePlan plan;
    plan.title = choice.title.empty() ? choice.plan.stem().stem().string() : choice.title;
    for (const std::string& text : choice.names) add_file_of(plan, text, choice.plan.parent_path());
    save_case_plan(plan, choice.plan);
    if (!choice.json) fmt::print("{}: {} fragments\n", choice.plan.string(), plan.fragments.size());
    return say(choice);
}

int plan_move(const PlanChoice& choice) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    const int fragment = find_fragment(plan, choice.names.front());
    do_step(plan, placing(plan, fragment, pose_of_text(choice.pose, "--pose"), "command"), choice.plan);
    return say(choice);
}

int plan_arrange(const PlanChoice& choice, const std::string& verb) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    PlanStep step;
    step.kind = kind_of(verb);
    step.by = "command";
    step.fragments = numbers_of_fragments(plan, choice.names);
    step.group = step.kind == StepKind::group && choice.group.empty() ? free_group_name(state_of(plan)) : choice.group;
    do_step(plan, std::move(step), choice.plan);
    return say(choice);
}

int plan_undo(const PlanChoice& choice) { return go(choice, undone, "nothing is left to undo"); }
int plan_redo(const PlanChoice& choice) { return go(choice, redone, "nothing is left to redo"); }

int plan_alternative(const PlanChoice& choice) {
    if (choice.alternative.empty()) return list_alternatives(choice);
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    const auto find = [&plan](const std::string& name) {
        return std::ranges::find(plan.alternatives, name, &PlanAlternative::name);
    };
    auto found = find(choice.alternative);
    if (choice.remove) {
        if (found == plan.alternatives.end() || found - plan.alternatives.begin() == plan.current)
            throw Error(fmt::format("'{}' cannot be removed: it is {}", choice.alternative,
                                    found == plan.alternatives.end() ? "not there" : "where the plan stands"));
        if (found - plan.alternatives.begin() < plan.current) --plan.current;
        plan.alternatives.erase(found);
    } else if (found == plan.alternatives.end()) {
        const auto from = choice.from.empty() ? plan.alternatives.begin() + plan.current : find(choice.from);
        if (from == plan.alternatives.end())
            throw Error(fmt::format("there is no alternative '{}' to begin from", choice.from));
        plan.alternatives.push_back({choice.alternative, after_step(from->place.head)});
        plan.current = static_cast<int>(plan.alternatives.size()) - 1;
    } else if (!choice.from.empty()) {
        throw Error(
            fmt::format("there is an alternative '{}' already; leave --from out to go there", choice.alternative));
    } else plan.current = static_cast<int>(found - plan.alternatives.begin());
    save_case_plan(plan, choice.plan);
    return say(choice);
}

}  // namespace tactus
