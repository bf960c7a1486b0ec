// SPDX-License-Identifier: Apache-2.0
// Where fragments of a plan belong by their own fractures.
#pragma once

#include "dsp/fit/fragment_matcher.hpp"
#include "dsp/fit/gap.hpp"
#include "tools/study/bones/surface_file.hpp"
#include "tools/study/planning/plan_case.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::study {

/// What was found for a fragment, and what is held against it.
struct PlanMatch {
    fit::FragmentMatch match;      ///< its verdict is `ambiguous` when it only repeats the scan
    bool as_scanned = false;  ///< it repeats the scan
    Pose from;                ///< where the fragment was
    Motion moved;             ///< of its middle from there
    bool was_painted = false; ///< in its file; otherwise its paint was proposed
};

/// The fragments of a plan, and the matcher that looks at them. Changes nothing of the plan.
class PlanMatching {
public:
    /// Throws Error for a file that is missing or has changed.
    PlanMatching(const cases::CasePlan& plan, const std::filesystem::path& folder);

    /// Of the paint of a fragment.
    std::size_t faces_of(int fragment) const { return matcher_->faces_of(fragment); }
    const CaseFragment& fragment(int n) const { return loaded_[static_cast<std::size_t>(n)]; }

    /// From where it is. Partners are all that are shown and do not move along, or `only` one of them.
    PlanMatch near(const fit::Arrangement& arrangement, int moving, int only = fit::Arrangement::none);
    /// From anywhere.
    PlanMatch anywhere(const fit::Arrangement& arrangement, int moving, int only = fit::Arrangement::none);

private:
    PlanMatch judged(const fit::FragmentMatch& made, const fit::Arrangement& arrangement) const;

    std::vector<CaseFragment> loaded_;
    std::vector<fit::FragmentSurface> surfaces_;
    std::unique_ptr<fit::FragmentMatcher> matcher_;
};

/// The step that places a fragment where it fits. `by`: who did it.
cases::PlanStep step_of(const cases::CasePlan& plan, const fit::FragmentMatch& match, const char* by);

/// Median distances of a whole fragment from the healthy side, m, at two places; none when the plan has no healthy side.
struct TargetDistances {
    double before = 0.0, there = 0.0;
};
std::optional<TargetDistances> target_distances(const cases::PlanState& state, const std::filesystem::path& folder,
                                                const CaseFragment& fragment, const Pose& from, const Pose& there);

/// Two fragments as they are placed.
struct PlanGap {
    int first = 0, second = 0;
    fit::SurfaceGap gap;
    double overlap = 0.0;  ///< m³
};
/// Of one pair, or of all that are shown and face each other. Throws Error.
std::vector<PlanGap> plan_gaps(const cases::CasePlan& plan, const std::filesystem::path& folder,
                               const std::optional<std::pair<int, int>>& pair);

}  // namespace tactus::study
