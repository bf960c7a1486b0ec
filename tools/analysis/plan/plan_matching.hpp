// SPDX-License-Identifier: Apache-2.0
// Matches the fractures of a plan's fragments.
#pragma once

#include "dsp/fit/fragment_matcher.hpp"
#include "dsp/fit/kerf_check.hpp"
#include "dsp/fit/mutual_gap.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// The match of a fragment, with possible doubts.
struct PlanMatch {
    fit::FragmentMatch match;      ///< the verdict is `ambiguous` if the fit only reproduces the scanned position
    bool as_scanned = false;  ///< the fit only reproduces the scanned position
    Pose from;                ///< pose of the fragment before
    Motion moved;             ///< motion of its centre from there
    bool was_painted = false; ///< the paint comes from the file; false: it was proposed
    int inside = fit::Arrangement::none;  ///< fragment that it would overlap; the verdict is `blocked`
    double inside_volume = 0.0;  ///< m³ of the overlap
    std::optional<fit::KerfEstimate> kerf;  ///< if faces fit; a doubt about it makes the verdict `ambiguous`
    bool is_apart = false;  ///< its partner is not connected to the fixed part, which it does not fit
};

/// Possible partners of a moving fragment: the fixed part (see fit::standing) and, if nothing of that fits, the other
/// visible fragments; or all visible ones together.
enum class Partners : std::uint8_t { standing_first, all };

/// Inputs of fits besides the faces.
struct FitWay {
    std::optional<double>
        kerf;  ///< m, width of the bone lost along the faces, which fits leave open; 0: nothing was lost
    bool with_healthy = false;  ///< the plan's healthy side, see dsp/fit/registration/healthy_pull.hpp
};

/// The fragments of a plan and a matcher for them. Does not change the plan.
class PlanMatching {
public:
    /// Throws Error for a file that is missing or has changed, and if a healthy side is requested that the plan does
    /// not have.
    PlanMatching(const plan::CasePlan& plan, const std::filesystem::path& folder, const FitWay& way = {});
    explicit PlanMatching(std::vector<CaseFragment> fragments, const FitWay& way = {});

    /// Number of painted faces of a fragment.
    std::size_t faces_of(int fragment) const { return matcher_->faces_of(fragment); }
    /// Area in m² of its surface in contact with another fragment in the scan, which no face covers.
    double as_scanned_area(int fragment) const {
        return contact::as_scanned_area(this->fragment(fragment).bone.points);
    }
    const fit::MatcherSettings& settings() const { return matcher_->settings; }
    const CaseFragment& fragment(int n) const { return loaded_[static_cast<std::size_t>(n)]; }
    fit::FragmentMatcher& matcher() { return *matcher_; }
    /// Returns whether two fragments overlap at these poses.
    bool lie_in_each_other(int a, const Pose& at, int b, const Pose& there) const;
    /// Returns the volume of their overlap, m³.
    double overlap_volume(int a, const Pose& at, int b, const Pose& there) const;
    /// Returns a match with doubts. `counts`: fragments that it must not overlap; empty: all shown ones.
    /// `case_opening`: estimate from the other pairs of the case, used if no kerf was given.
    PlanMatch judged(const fit::FragmentMatch& made, const fit::Arrangement& arrangement,
                     const std::vector<char>& counts = {}, const fit::CommonOpening& case_opening = {}) const;

    /// Fits a fragment from its current pose. Fragments that move with it are not partners. `only`: restricts it to one
    /// partner.
    PlanMatch near(const fit::Arrangement& arrangement, int moving, Partners partners,
                   int only = fit::Arrangement::none);
    /// Fits a fragment from any pose, first to the fixed part.
    PlanMatch anywhere(const fit::Arrangement& arrangement, int moving, int only = fit::Arrangement::none);

private:
    /// Empty if no faces of the two are in contact.
    std::optional<fit::KerfEstimate> estimate_kerf(const PlanMatch& found, const fit::Arrangement& arrangement) const;
    void look_for_overlap(PlanMatch& found, const fit::Arrangement& arrangement, const std::vector<char>& counts) const;

    void make_matcher();

    std::vector<CaseFragment> loaded_;
    FitWay way_;
    std::optional<fit::RegistrationTarget> healthy_;
    std::vector<fit::FragmentSurface> surfaces_;
    std::unique_ptr<fit::FragmentMatcher> matcher_;
};

/// The command that places a fragment at its match.
plan::SettleFragment settling(const fit::FragmentMatch& match);

/// Median distances of a whole fragment to the healthy side, m, at two poses; empty if the plan has no healthy side.
struct TargetDistances {
    double before = 0.0, there = 0.0;
};
std::optional<TargetDistances> target_distances(const plan::PlanState& state, const std::filesystem::path& folder,
                                                const CaseFragment& fragment, const Pose& from, const Pose& there);

/// Returns the distance of each fragment at its planned pose, m; all empty if the plan has no healthy side. Throws
/// Error.
std::vector<std::optional<double>> healthy_residuals(const plan::PlanState& state, const std::filesystem::path& folder,
                                                     const std::vector<CaseFragment>& fragments);

/// Gap between two placed fragments.
struct PlanGap {
    int first = 0, second = 0;
    fit::MutualGap gap;
    double overlap = 0.0;  ///< m³; 0 if no point of either is deeper than 5 µm in the other
};
/// Returns the gaps of one pair, or of all visible pairs that face each other or overlap. Throws Error.
std::vector<PlanGap> plan_gaps(const plan::CasePlan& plan, const std::filesystem::path& folder,
                               const std::optional<std::pair<int, int>>& pair);

}  // namespace tactus::analysis
