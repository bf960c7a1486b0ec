// SPDX-License-Identifier: Apache-2.0
// tactus plan gap: gap, contact and overlap of placed fragments.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

using file::Json;

Json json_of(const plan::CasePlan& plan, const std::vector<analysis::PlanGap>& gaps) {
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    Json pairs = Json::array();
    for (const analysis::PlanGap& g : gaps) {
        // Without surfaces that face each other there is no gap.
        const bool is_facing = g.gap.facing > 0.0;
        pairs.push_back({{"fragments", {name(g.first), name(g.second)}},
                         {"facing_mm2", g.gap.facing * 1e6},
                         {"contact_mm2", g.gap.contact * 1e6},
                         {"gap_median_mm", is_facing ? Json(g.gap.median * 1e3) : Json(nullptr)},
                         {"gap_p95_mm", is_facing ? Json(g.gap.p95 * 1e3) : Json(nullptr)},
                         {"deepest_mm", g.gap.deepest * 1e3},
                         {"overlap_mm3", g.overlap * 1e9}});
    }
    return pairs;
}

void print(const plan::CasePlan& plan, const std::vector<analysis::PlanGap>& gaps) {
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    if (gaps.empty()) fmt::print("no two shown fragments face each other within 3 mm\n");
    for (const analysis::PlanGap& g : gaps)
        if (!(g.gap.facing > 0.0))
            fmt::print("{} and {}: do not face each other within 3 mm; {:.1f} mm³ overlap{}\n", name(g.first),
                       name(g.second), g.overlap * 1e9,
                       g.gap.deepest > 0.0 ? fmt::format(", {:.2f} mm deep", g.gap.deepest * 1e3) : "");
        else
            fmt::print(
                "{} and {}: {:.0f} mm² face each other, {:.0f} mm² touch; gap {:.2f} mm (95 %: {:.2f} mm), "
                "{:.1f} mm³ overlap, {:.2f} mm deep\n",
                name(g.first), name(g.second), g.gap.facing * 1e6, g.gap.contact * 1e6,
                analysis::shown_mm(g.gap.median * 1e3), g.gap.p95 * 1e3, g.overlap * 1e9, g.gap.deepest * 1e3);
}

int gap(const PlanChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    if (!choice.names.empty() && (choice.names.size() != 2 || choice.names[0] == choice.names[1]))
        throw Error("'plan gap' needs two different fragments, or none");
    const std::filesystem::path folder = choice.plan.parent_path();
    std::optional<std::pair<int, int>> pair;
    if (!choice.names.empty())
        pair = {plan::find_fragment(plan, choice.names[0]), plan::find_fragment(plan, choice.names[1])};
    const std::vector<analysis::PlanGap> gaps = analysis::plan_gaps(plan, folder, pair);
    if (choice.json) fmt::print("{}\n", json_of(plan, gaps).dump(2));
    else print(plan, gaps);
    return done;
}

Action declare_plan_gap(VerbOptions& verb) {
    const auto choice = std::make_shared<PlanChoice>();
    add_plan_options(verb, *choice);
    verb.add("fragments", choice->names, "two fragments (default: all pairs that face each other)");
    return [choice] { return gap(*choice); };
}

}  // namespace

Verb plan_gap_verb() { return {"gap", "measure gap, contact and overlap of placed fragments", declare_plan_gap}; }

}  // namespace tactus::command
