// SPDX-License-Identifier: Apache-2.0
// tactus plan mirror: registers the mirrored healthy side as a target.
#include "tools/analysis/plan/plan_mirror.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/mirror_result.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

namespace {

struct MirrorChoice : PlanChoice {
    std::filesystem::path healthy;
    bool settle = false, same_side = false;
    double max_residual = analysis::max_intact_median / mm;
};

/// A side that lies wrongly is no target: the plan does not use it, and nothing is compared with it.
bool is_doubtful(const MirrorChoice& choice, const fit::MirrorFit& fit) {
    return fit.registration.median > choice.max_residual * mm;
}

const char* target_words(const MirrorChoice& choice) { return choice.same_side ? "same side" : "mirrored side"; }

std::string doubt_words(const MirrorChoice& choice) {
    return fmt::format(
        "the {} lies more than {:.3g} mm away from half of '{}', so that it is no target: name the largest fragment "
        "first, and check that {} is the same bone of {} side, or raise --max-residual; the plan is "
        "unchanged",
        target_words(choice), choice.max_residual, choice.names[0], choice.healthy.string(),
        choice.same_side ? "the same" : "the other");
}

void add_target(plan::CasePlan& plan, const analysis::MirrorStudy& laid, const MirrorChoice& choice) {
    plan::PlanStep step;
    step.kind = plan::StepKind::mirror;
    step.by = "command";
    step.mirror = laid.target();
    analysis::do_step(plan, std::move(step), choice.plan);
}

/// Compares the other fragments with the mirrored side, and moves them there if requested.
std::vector<report::ComparedFragment> compare_others(plan::CasePlan& plan, analysis::MirrorStudy& laid,
                                                     const std::vector<int>& others, const MirrorChoice& choice) {
    std::vector<report::ComparedFragment> compared;
    for (const int other : others) {
        compared.push_back({plan.fragments[static_cast<std::size_t>(other)].name,
                            laid.compare(other, plan::state_of(plan).arrangement.pose(other))});
        if (choice.settle)
            analysis::change_plan(plan, plan::PlaceFragment{other, compared.back().found.registration.pose},
                                  {.by = "mirror"}, choice.plan);
    }
    return compared;
}

int mirror(const MirrorChoice& choice) {
    check_plan_results(choice, {choice.healthy});
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<int> numbers;
    for (const std::string& name : choice.names) {
        numbers.push_back(plan::find_fragment(plan, name));
        if (std::ranges::count(numbers, numbers.back()) > 1)
            throw Error(
                fmt::format("'{}' is named twice; the first is the main fragment, the others are brought to it", name));
    }
    analysis::MirrorStudy laid(plan, folder, numbers[0], choice.healthy, !choice.same_side);
    const bool is_refused = is_doubtful(choice, laid.fit());
    report::LaidTarget result{
        choice.names[0], !choice.same_side, is_refused ? doubt_words(choice) : "", &laid.fit(), {}};
    if (!is_refused) {
        add_target(plan, laid, choice);
        numbers.erase(numbers.begin());
        result.others = compare_others(plan, laid, numbers, choice);
    }
    for (const std::string& note : laid.notes()) fmt::print(stderr, "note: {}\n", note);
    write_result(report::laid_target_fields().of(result), choice.result);
    return is_refused ? answer_is_no : done;
}

Action declare_plan_mirror(VerbOptions& verb) {
    const auto choice = std::make_shared<MirrorChoice>();
    add_plan_report_options(verb, *choice);
    verb.add("healthy", choice->healthy, "bone file or mesh of the other side, or of the same side").required();
    add_fragments(verb, *choice, "the fixed fragment; further fragments are compared, or moved with --settle");
    verb.flag("--same-side", choice->same_side,
              "do not mirror: the bone is of the same side, as that of another person or of an earlier scan");
    verb.add("--max-residual", choice->max_residual, "mm, largest median distance from the fixed fragment")
        .range(0.1, 20.0)
        .shows_default();
    verb.flag("--settle", choice->settle, "move the other fragments to their best pose on the target");
    return [choice] { return mirror(*choice); };
}

}  // namespace

Verb plan_mirror_verb() {
    return {
        .name = "mirror",
        .about =
            "register the mirrored healthy side, or another bone, to a fragment, as a target; 1: the target is too far "
            "from the fragment",
        .add = declare_plan_mirror,
        .schema = [] { return report::schema_of_output({report::laid_target_fields().schema()}); }};
}

}  // namespace tactus::command
