// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_matching.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/fit/arrangement/assemblies.hpp"
#include "dsp/fit/as_scanned.hpp"
#include "dsp/fit/overlap.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/plan/plan_overlaps.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

std::vector<Pose> poses_of(const fit::Arrangement& a) {
    std::vector<Pose> poses;
    for (int n = 0; n < static_cast<int>(a.size()); ++n) poses.push_back(a.pose(n));
    return poses;
}

/// Possible partners: all visible fragments that do not move along, or only the given one.
std::vector<char> partners_of(const fit::Arrangement& a, int moving, int only) {
    std::vector<char> stands;
    for (int n = 0; n < static_cast<int>(a.size()); ++n)
        stands.push_back(!a.move_together(moving, n) && (only == fit::Arrangement::none ? !a.is_hidden(n) : n == only));
    return stands;
}

}  // namespace

PlanMatching::PlanMatching(const plan::CasePlan& plan, const std::filesystem::path& folder, const FitWay& way)
    : loaded_(load_fragments(plan, folder, plan::Paint::or_proposed)), way_(way) {
    if (way.with_healthy) {
        const auto mirror = plan::state_of(plan).mirror;
        if (!mirror) throw Error("the plan has no healthy side: lay it on a fragment with 'tactus plan mirror'");
        healthy_.emplace(laid_target(*mirror, folder));
    }
    make_matcher();
}

PlanMatching::PlanMatching(std::vector<CaseFragment> fragments, const FitWay& way)
    : loaded_(std::move(fragments)), way_(way) {
    make_matcher();
}

void PlanMatching::make_matcher() {
    for (const CaseFragment& f : loaded_) surfaces_.push_back({f.bone.points, &f.map.grid});
    fit::MatcherSettings settings;
    settings.max_points = 2000;
    settings.fit.kerf = way_.kerf.value_or(0.0);
    if (healthy_) settings.healthy.side = &*healthy_;
    matcher_ = std::make_unique<fit::FragmentMatcher>(surfaces_, settings);
}

bool PlanMatching::lie_in_each_other(int a, const Pose& at, int b, const Pose& there) const {
    return fit::lie_in_each_other(placed_bone(fragment(a), at), placed_bone(fragment(b), there),
                                  settings().fit.max_penetration);
}

double PlanMatching::overlap_volume(int a, const Pose& at, int b, const Pose& there) const {
    return fit::overlap_volume(fragment(a).map.grid, at, fragment(b).map, there);
}

std::optional<fit::KerfEstimate> PlanMatching::estimate_kerf(const PlanMatch& found,
                                                             const fit::Arrangement& arrangement) const {
    const int moving = found.match.moving, partner = found.match.partner;
    std::vector<Pose> poses = poses_of(arrangement);
    poses[static_cast<std::size_t>(moving)] = found.match.pose;
    fit::FitEnergy energy = matcher_->make_energy();
    const fit::FitSurface *mine = nullptr, *other = nullptr;
    double most = 0.0;
    for (std::size_t m = 0; m < matcher_->faces(); ++m)
        for (std::size_t f = 0; f < matcher_->faces(); ++f) {
            if (matcher_->fragment_of(m) != moving || matcher_->fragment_of(f) != partner) continue;
            const fit::FitQuality q = matcher_->quality_of(energy, m, f, poses);
            if (!(q.score * std::sqrt(q.overlap) > most)) continue;
            most = q.score * std::sqrt(q.overlap);
            mine = &matcher_->face(m);
            other = &matcher_->face(f);
        }
    if (!mine) return std::nullopt;
    const Pose between = arrangement.pose(partner).inverse() * found.match.pose;
    return fit::check_kerf({fragment(moving).bone.points, mine}, {fragment(partner).bone.points, other}, between,
                           way_.kerf);
}

/// Looks for the fragment that what moves would lie in most.
void PlanMatching::look_for_overlap(PlanMatch& found, const fit::Arrangement& arrangement,
                                    const std::vector<char>& counts) const {
    const int moving = found.match.moving, count = static_cast<int>(arrangement.size());
    const Pose motion = found.match.pose * arrangement.pose(moving).inverse();
    for (int m = 0; m < count; ++m) {
        if (!arrangement.move_together(moving, m)) continue;
        const Pose at = m == moving ? found.match.pose : motion * arrangement.pose(m);
        for (int n = 0; n < count; ++n) {
            if (arrangement.move_together(moving, n)) continue;
            if (counts.empty() ? arrangement.is_hidden(n) : !counts[static_cast<std::size_t>(n)]) continue;
            if (!lie_in_each_other(m, at, n, arrangement.pose(n))) continue;
            const double volume = overlap_volume(m, at, n, arrangement.pose(n));
            if (found.inside != fit::Arrangement::none && !(volume > found.inside_volume)) continue;
            found.inside = n;
            found.inside_volume = volume;
        }
    }
}

PlanMatch PlanMatching::judged(const fit::FragmentMatch& made, const fit::Arrangement& arrangement,
                               const std::vector<char>& counts, const fit::CommonOpening& case_opening) const {
    PlanMatch found;
    found.match = made;
    found.from = arrangement.pose(made.moving);
    found.was_painted = fragment(made.moving).was_painted;
    const std::vector<contact::SurfacePoint>& points = fragment(made.moving).bone.points;
    // A fit that only reproduces the scanned position gives no information about the correct pose.
    const auto has_place = [&found] {
        return found.match.verdict == fit::FitVerdict::fit || found.match.verdict == fit::FitVerdict::uncertain;
    };
    found.as_scanned = has_place() && fit::is_as_scanned(points, arrangement.pose(made.partner).inverse() * made.pose,
                                                         fragment(made.partner).map);
    if (found.as_scanned) found.match.verdict = fit::FitVerdict::ambiguous;
    if (has_place() && (found.kerf = estimate_kerf(found, arrangement))) {
        if (!found.kerf->given && !found.kerf->is_flat && case_opening.excludes_kerf(found.kerf->contour)) {
            found.kerf->is_contradicted = found.kerf->is_open = false;
            found.kerf->loss = 0.0;
        }
        found.match.verdict = fit::include_kerf(*found.kerf, found.match.verdict, found.match.bound);
    }
    if (has_place()) {
        look_for_overlap(found, arrangement, counts);
        if (found.inside != fit::Arrangement::none) found.match.verdict = fit::FitVerdict::blocked;
    }
    found.moved = motion_between(found.from, made.pose, middle_of(points));
    return found;
}

namespace {

/// `look(stands)` with what stands; when that does not fit, with all partners.
template <class Look>
PlanMatch standing_first(const fit::Arrangement& a, int moving, int only, const Look& look) {
    std::vector<char> stands = fit::standing(a, moving);
    const std::vector<char> all = partners_of(a, moving, only);
    for (std::size_t n = 0; n < stands.size(); ++n) stands[n] = stands[n] && all[n];
    const bool is_some = std::ranges::find(stands, 1) != stands.end();
    if (is_some) {
        PlanMatch found = look(stands);
        if (found.match.verdict == fit::FitVerdict::fit || stands == all) return found;
    }
    PlanMatch found = look(all);
    found.is_apart = is_some && found.match.verdict == fit::FitVerdict::fit &&
                     !stands[static_cast<std::size_t>(found.match.partner)];
    return found;
}

}  // namespace

PlanMatch PlanMatching::near(const fit::Arrangement& arrangement, int moving, Partners partners, int only) {
    const auto look = [&](const std::vector<char>& stands) {
        return judged(matcher_->near(moving, poses_of(arrangement), stands), arrangement);
    };
    if (partners == Partners::all || only != fit::Arrangement::none)
        return look(partners_of(arrangement, moving, only));
    return standing_first(arrangement, moving, only, look);
}

PlanMatch PlanMatching::anywhere(const fit::Arrangement& arrangement, int moving, int only) {
    const auto poses = poses_of(arrangement);
    return standing_first(arrangement, moving, only, [&](const std::vector<char>& stands) {
        fit::FragmentMatch match = matcher_->near(moving, poses, stands);
        matcher_->begin_search();
        do match = matcher_->search(moving, poses, stands);
        while (matcher_->left() > 0);
        return judged(match, arrangement);
    });
}

plan::SettleFragment settling(const fit::FragmentMatch& match) {
    const fit::FitQuality& q = match.quality;
    // Only a fit connects: at any other place the step names no partner.
    return {match.moving,
            match.verdict == fit::FitVerdict::fit ? match.partner : fit::Arrangement::none,
            match.pose,
            {q.score, match.margin, q.rms, q.gap, q.penetration, q.overlap}};
}

std::optional<TargetDistances> target_distances(const plan::PlanState& state, const std::filesystem::path& folder,
                                                const CaseFragment& fragment, const Pose& from, const Pose& there) {
    if (!state.mirror) return std::nullopt;
    const fit::RegistrationTarget target(laid_target(*state.mirror, folder));
    return TargetDistances{fit::median_distance(fragment.bone.points, target, from),
                           fit::median_distance(fragment.bone.points, target, there)};
}

std::vector<std::optional<double>> healthy_residuals(const plan::PlanState& state, const std::filesystem::path& folder,
                                                     const std::vector<CaseFragment>& fragments) {
    std::vector<std::optional<double>> all(fragments.size());
    if (!state.mirror) return all;
    const fit::RegistrationTarget target(laid_target(*state.mirror, folder));
    for (std::size_t n = 0; n < fragments.size(); ++n)
        all[n] = fit::median_distance(fragments[n].bone.points, target, state.arrangement.pose(static_cast<int>(n)));
    return all;
}

std::vector<PlanGap> plan_gaps(const plan::CasePlan& plan, const std::filesystem::path& folder,
                               const std::optional<std::pair<int, int>>& pair) {
    constexpr double min_depth = 5e-6;  // m
    plan::check_files(plan, folder);
    const plan::PlanState state = plan::state_of(plan);
    const std::vector<plan::PlanFragment> fragments = plan::fragments_of(plan, state);
    std::vector<CaseFragment> loaded(fragments.size());
    for (int n = 0; n < static_cast<int>(fragments.size()); ++n) {
        leave_if_stopped();
        const bool is_needed = pair ? n == pair->first || n == pair->second : !state.arrangement.is_hidden(n);
        if (is_needed)
            loaded[static_cast<std::size_t>(n)] = load_fragment(fragments[static_cast<std::size_t>(n)], folder);
    }
    std::vector<PlanGap> found;
    const auto look = [&](int i, int j) {
        leave_if_stopped();
        const CaseFragment &a = loaded[static_cast<std::size_t>(i)], &b = loaded[static_cast<std::size_t>(j)];
        const Pose &at = state.arrangement.pose(i), &bt = state.arrangement.pose(j);
        const fit::MutualGap gap = fit::mutual_gap(placed_bone(a, at), placed_bone(b, bt));
        // Surfaces that only touch share fractions of voxels, which are no overlap.
        const bool is_inside = gap.deepest > min_depth;
        const double overlap = is_inside ? fit::overlap_volume(a.map.grid, at, b.map, bt) : 0.0;
        // What lies deep inside of another does not face it.
        if (!pair && !(gap.facing > 5e-6) && !(overlap > 5e-9)) return;
        found.push_back({i, j, gap, overlap});
    };
    if (pair) look(pair->first, pair->second);
    else
        for (int i = 0; i < static_cast<int>(loaded.size()); ++i)
            for (int j = i + 1; j < static_cast<int>(loaded.size()); ++j)
                if (!state.arrangement.is_hidden(i) && !state.arrangement.is_hidden(j)) look(i, j);
    return found;
}

}  // namespace tactus::analysis
