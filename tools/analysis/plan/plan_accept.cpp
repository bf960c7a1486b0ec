// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_accept.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/arrangement/assemblies.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_matching.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::analysis {

namespace {

const std::string& name_in(const plan::CasePlan& plan, int n) {
    return plan.fragments[static_cast<std::size_t>(n)].name;
}

int partner_of(const plan::CasePlan& plan, const plan::PlanState& state, int fragment) {
    const fit::Arrangement& a = state.arrangement;
    const std::vector<char> stands = fit::standing(a, fragment);
    for (const bool must_stand : {true, false})
        for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n)
            if (n != fragment && !a.is_hidden(n) && (!must_stand || stands[static_cast<std::size_t>(n)])) return n;
    throw Error(fmt::format("'{}' is the only fragment that is shown: there is nothing beside which it is placed",
                            name_in(plan, fragment)));
}

double mirror_residual(const plan::CasePlan& plan, const plan::PlanState& state, const std::filesystem::path& folder,
                       int fragment) {
    const plan::PlanFragment one = plan::fragments_of(plan, state)[static_cast<std::size_t>(fragment)];
    const Pose& pose = state.arrangement.pose(fragment);
    const auto found = target_distances(state, folder, load_fragment(one, folder), pose, pose);
    if (!found) throw Error("the plan has no healthy side; 'tactus plan mirror' lays it on the case");
    if (found->there > max_mirror_residual)
        throw Error(
            fmt::format("'{}' lies {:.2f} mm (median) from the mirrored side, more than {:.1f} mm; move it there "
                        "with 'tactus plan mirror --settle', or accept it with --by hand",
                        name_in(plan, fragment), found->there / mm, max_mirror_residual / mm));
    return found->there;
}

double plan_residual(const plan::CasePlan& plan, const plan::PlanState& state, const std::filesystem::path& folder,
                     int fragment) {
    if (std::ranges::find(state.pieces, fragment) == state.pieces.end())
        throw Error(fmt::format("'{}' is no piece of a reconstruction: accept it with --by hand or --by mirror",
                                name_in(plan, fragment)));
    for (const CaseWarning& warning : known_warnings(plan, folder).all)
        if (warning.object == name_in(plan, fragment) &&
            (warning.code == "not-placed" || warning.code == "away-from-plan" || warning.code == "accepted-away"))
            throw Error(warning.text + "; --by hand accepts it where it is");
    return 0.0;
}

const char* verdict_of(AcceptedBy by) {
    switch (by) {
        case AcceptedBy::hand: return "accepted by hand";
        case AcceptedBy::mirror: return "accepted by mirror";
        case AcceptedBy::plan: return "accepted by plan";
    }
    return "";
}

}  // namespace

Acceptance measure_acceptance(const plan::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                              AcceptedBy by, std::optional<int> partner) {
    const plan::PlanState state = plan::state_of(plan);
    const int beside = partner.value_or(partner_of(plan, state, fragment));
    if (beside == fragment) throw Error(fmt::format("'{}' cannot be its own partner", name_in(plan, fragment)));
    for (const int n : {fragment, beside})
        if (state.arrangement.is_hidden(n))
            throw Error(fmt::format("'{}' is hidden; show it with 'tactus plan unhide'", name_in(plan, n)));
    Acceptance found;
    found.partner = name_in(plan, beside);
    if (by == AcceptedBy::mirror) found.residual = mirror_residual(plan, state, folder, fragment);
    if (by == AcceptedBy::plan) found.residual = plan_residual(plan, state, folder, fragment);
    for (const PlanGap& pair : plan_gaps(plan, folder, std::pair(fragment, beside))) {
        found.gap = pair.gap.median;
        found.penetration = pair.gap.deepest;
        found.facing = pair.gap.facing;
        if (by == AcceptedBy::hand) found.residual = std::abs(pair.gap.median);
    }
    return found;
}

plan::PlanStep step_of(const plan::CasePlan& plan, int fragment, AcceptedBy by, const Acceptance& found) {
    const Pose pose = plan::state_of(plan).arrangement.pose(fragment);
    plan::PlanStep step = plan::placing(plan, fragment, pose, "hand");
    plan::PlanFit record;
    record.partner = found.partner;
    record.verdict = verdict_of(by);
    record.rms = found.residual;
    record.gap = found.gap;
    record.penetration = found.penetration;
    record.overlap = found.facing;
    step.fit = record;
    return step;
}

}  // namespace tactus::analysis
