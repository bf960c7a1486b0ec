// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_accept.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/arrangement/assemblies.hpp"
#include "dsp/fit/mutual_gap.hpp"
#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_matching.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tactus::analysis {

namespace {

const std::string& name_in(const plan::CasePlan& plan, int n) {
    return plan.fragments[static_cast<std::size_t>(n)].name;
}

/// Fragments that may be the partner: those that are placed, or all shown ones if none is.
std::vector<int> partners_for(const plan::CasePlan& plan, const plan::PlanState& state, int fragment) {
    const fit::Arrangement& a = state.arrangement;
    const std::vector<char> stands = fit::standing(a, fragment);
    std::vector<int> found;
    for (const bool must_stand : {true, false}) {
        for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n)
            if (n != fragment && !a.is_hidden(n) && (!must_stand || stands[static_cast<std::size_t>(n)]))
                found.push_back(n);
        if (!found.empty()) return found;
    }
    throw Error(fmt::format("'{}' is the only fragment that is shown: there is nothing beside which it is placed",
                            name_in(plan, fragment)));
}

/// m, between the surfaces; by at most 2000 points of each, hence to about a millimetre.
double distance_between(const fit::PlacedBone& a, const fit::PlacedBone& b) {
    constexpr std::size_t max_points = 2000;
    double least2 = std::numeric_limits<double>::infinity();
    const std::size_t step_a = a.points.size() / max_points + 1, step_b = b.points.size() / max_points + 1;
    const Pose into = b.points_pose.inverse() * a.points_pose;
    for (std::size_t i = 0; i < a.points.size(); i += step_a) {
        const Vec3 p = into.apply(a.points[i].position);
        for (std::size_t j = 0; j < b.points.size(); j += step_b) {
            const Vec3 apart = b.points[j].position - p;
            least2 = std::min(least2, glm::dot(apart, apart));
        }
    }
    return std::sqrt(least2);
}

/// Measures against the partner that faces the fragment over the largest area, or that is nearest if none faces it.
void measure_neighbour(Acceptance& found, const plan::CasePlan& plan, const plan::PlanState& state,
                       const std::filesystem::path& folder, int fragment, const std::vector<int>& partners) {
    const std::vector<plan::PlanFragment> fragments = plan::fragments_of(plan, state);
    const CaseFragment mine = load_fragment(fragments[static_cast<std::size_t>(fragment)], folder);
    const fit::PlacedBone here = placed_bone(mine, state.arrangement.pose(fragment));
    found.apart = std::numeric_limits<double>::infinity();
    for (const int n : partners) {
        const CaseFragment other = load_fragment(fragments[static_cast<std::size_t>(n)], folder);
        const fit::PlacedBone there = placed_bone(other, state.arrangement.pose(n));
        const fit::MutualGap gap = fit::mutual_gap(here, there);
        const double apart = gap.facing > 0.0 || gap.deepest > 0.0 ? 0.0 : distance_between(here, there);
        if (gap.facing > 0.0 ? !(gap.facing > found.facing) : found.facing > 0.0 || !(apart < found.apart)) continue;
        found.partner = name_in(plan, n);
        found.gap = gap.median;
        found.penetration = gap.deepest;
        found.facing = gap.facing;
        found.apart = apart;
    }
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

}  // namespace

Acceptance measure_acceptance(const plan::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                              plan::FitBasis by, std::optional<int> partner) {
    const plan::PlanState state = plan::state_of(plan);
    if (partner == fragment) throw Error(fmt::format("'{}' cannot be its own partner", name_in(plan, fragment)));
    const std::vector<int> partners = partner ? std::vector<int>{*partner} : partners_for(plan, state, fragment);
    for (const int n : {fragment, partners.front()})
        if (state.arrangement.is_hidden(n))
            throw Error(fmt::format("'{}' is hidden; show it with 'tactus plan unhide'", name_in(plan, n)));
    plan::check_files(plan, folder);
    Acceptance found;
    if (by == plan::FitBasis::mirror) found.residual = mirror_residual(plan, state, folder, fragment);
    if (by == plan::FitBasis::plan) found.residual = plan_residual(plan, state, folder, fragment);
    measure_neighbour(found, plan, state, folder, fragment, partners);
    if (by == plan::FitBasis::hand)
        found.residual = found.facing > 0.0        ? std::abs(found.gap)
                         : found.penetration > 0.0 ? found.penetration
                                                   : found.apart;
    return found;
}

plan::SettleFragment accepting(const plan::CasePlan& plan, int fragment, plan::FitBasis by, const Acceptance& found) {
    return {fragment,
            plan::find_fragment(plan, found.partner),
            plan::state_of(plan).arrangement.pose(fragment),
            {0.0, 0.0, found.residual, found.gap, found.penetration, found.facing},
            by};
}

}  // namespace tactus::analysis
