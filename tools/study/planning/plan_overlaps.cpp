// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_overlaps.hpp"

#include "dsp/fit/fit.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/overlap.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::study {

std::vector<PlanOverlap> plan_overlaps(const cases::CasePlan& plan, const std::filesystem::path& folder) {
    const cases::PlanState state = cases::state_of(plan);
    const std::vector<CaseFragment> loaded = load_fragments(plan, folder);
    const auto placed = [&](int n) {
        const CaseFragment& f = loaded[static_cast<std::size_t>(n)];
        const Pose& pose = state.arrangement.pose(n);
        return fit::PlacedBone{f.bone.points, &f.map, pose, pose};
    };
    std::vector<PlanOverlap> found;
    for (int a = 0; a < static_cast<int>(loaded.size()); ++a)
        for (int b = a + 1; b < static_cast<int>(loaded.size()); ++b) {
            if (state.arrangement.is_hidden(a) || state.arrangement.is_hidden(b) ||
                !fit::lie_in_each_other(placed(a), placed(b), fit::FitSettings{}.most_penetration))
                continue;
            found.push_back(
                {a, b,
                 fit::overlap_volume(loaded[static_cast<std::size_t>(a)].bone.distance, state.arrangement.pose(a),
                                     loaded[static_cast<std::size_t>(b)].map, state.arrangement.pose(b))});
        }
    return found;
}

double deepest_between(const CaseFragment& a, const Pose& at, const CaseFragment& b, const Pose& there) {
    return std::max(fit::gap_between(a.bone.points, at, b.map, there).deepest,
                    fit::gap_between(b.bone.points, there, a.map, at).deepest);
}

std::string overlap_words(const cases::CasePlan& plan, const PlanOverlap& overlap) {
    return fmt::format("'{}' and '{}' lie in each other with {:.0f} mm³; move or hide one of them",
                       plan.fragments[static_cast<std::size_t>(overlap.first)].name,
                       plan.fragments[static_cast<std::size_t>(overlap.second)].name, overlap.volume * 1e9);
}

}  // namespace tactus::study
