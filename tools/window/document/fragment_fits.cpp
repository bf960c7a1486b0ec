// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/fragment_fits.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/plan/match_reason.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <exception>
#include <utility>

namespace tactus::window {

namespace {

// Candidates with the same partner that lie this close together count as one.
constexpr double same_m = 1e-3, same_rad = 0.03;

/// From certain to impossible; equal ones by their score.
int rank_of(fit::FitVerdict verdict) {
    switch (verdict) {
        case fit::FitVerdict::fit: return 0;
        case fit::FitVerdict::uncertain: return 1;
        case fit::FitVerdict::ambiguous: return 2;
        case fit::FitVerdict::sliding: return 3;
        case fit::FitVerdict::blocked: return 4;
        case fit::FitVerdict::no_match: break;
    }
    return 5;
}

FitCandidate candidate_of(const plan::CasePlan& plan, const analysis::PlanMatching& matching,
                          const fit::Arrangement& now, const analysis::PlanMatch& found, int only,
                          analysis::MatchWay way) {
    const fit::FragmentMatch& match = found.match;
    const fit::FitQuality& q = match.quality;
    FitCandidate made;
    made.verdict = match.verdict;
    made.step = analysis::settling(match);
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    made.words = fmt::format("{} to {}: {}, score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.2f} mm rms",
                             name(match.moving), name(match.partner), fit::name_of(match.verdict), q.score,
                             match.margin, q.overlap * 1e6, q.rms * 1e3);
    const std::string why = found.as_scanned ? "this only repeats where the scan has it"
                                             : why_not_placed(plan, matching, now, found, only, way);
    if (!why.empty()) made.words += "; " + why;
    return made;
}

bool is_same(const FitCandidate& a, const FitCandidate& b) {
    const Pose &p = a.step.pose, &q = b.step.pose;
    return a.step.partner == b.step.partner && glm::length(p.position - q.position) < same_m &&
           glm::length(rotation_between(p.orientation, q.orientation)) < same_rad;
}

}  // namespace

analysis::PlanMatching& FragmentFits::Shared::of(const plan::CasePlan& plan) {
    std::string wanted;
    for (const plan::PlanFragment& fragment : plan::fragments_of(plan))
        wanted += fmt::format("{}\n{}\n{}\n", fragment.name, fragment.file, fragment.hash);
    if (!matching || wanted != files) {
        matching.reset();
        matching = std::make_unique<analysis::PlanMatching>(plan, std::filesystem::path());
        files = std::move(wanted);
    }
    return *matching;
}

void FragmentFits::search(const std::shared_ptr<const plan::CasePlan>& plan, int fragment) {
    shared_->progress = 0.0;
    searching_.begin(analysis::Lane::moves, [shared = shared_, plan, fragment](std::stop_token stop) {
        const StopScope scope(stop);
        Found found{fragment, plan, {}, {}};
        analysis::PlanMatching& matching = shared->of(*plan);
        if (matching.faces_of(fragment) == 0) {
            found.reason = analysis::no_fracture_words(matching.as_scanned_area(fragment));
            return found;
        }
        const fit::Arrangement now = plan::state_of(*plan).arrangement;
        const auto count = static_cast<int>(now.size());
        const auto take = [&](const analysis::PlanMatch& match, int only, analysis::MatchWay way) {
            if (match.match.partner == fit::Arrangement::none) {
                if (found.reason.empty()) found.reason = why_not_placed(*plan, matching, now, match, only, way);
                return;
            }
            if (match.match.verdict == fit::FitVerdict::no_match) {
                if (found.reason.empty()) found.reason = candidate_of(*plan, matching, now, match, only, way).words;
                return;
            }
            FitCandidate made = candidate_of(*plan, matching, now, match, only, way);
            if (std::ranges::none_of(found.candidates, [&](const FitCandidate& one) { return is_same(one, made); }))
                found.candidates.push_back(std::move(made));
        };
        const double parts = count + 2;
        take(matching.near(now, fragment, analysis::Partners::standing_first), fit::Arrangement::none,
             analysis::MatchWay::near);
        shared->progress = 1.0 / parts;
        if (stop.stop_requested()) return found;
        if (found.candidates.empty() || !found.candidates.front().fits())
            take(matching.anywhere(now, fragment), fit::Arrangement::none, analysis::MatchWay::anywhere);
        for (int other = 0; other < count && !stop.stop_requested(); ++other) {
            shared->progress = (2.0 + other) / parts;
            if (now.move_together(fragment, other) || now.is_hidden(other)) continue;
            take(matching.near(now, fragment, analysis::Partners::all, other), other, analysis::MatchWay::near);
        }
        std::ranges::stable_sort(found.candidates, [](const FitCandidate& a, const FitCandidate& b) {
            const int first = rank_of(a.verdict), second = rank_of(b.verdict);
            return first != second ? first < second : a.step.fit.score > b.step.fit.score;
        });
        return found;
    });
}

std::optional<FragmentFits::Found> FragmentFits::take() {
    if (!searching_.is_ready()) return std::nullopt;
    return searching_.take();
}

void FragmentFits::look_near(const std::shared_ptr<const plan::CasePlan>& plan, const fit::Arrangement& now,
                             int fragment) {
    if (looking_.is_busy()) return;
    looking_.begin(analysis::Lane::moves, [shared = shared_, plan, now, fragment](std::stop_token stop) {
        const StopScope scope(std::move(stop));
        analysis::PlanMatching& matching = shared->of(*plan);
        const analysis::PlanMatch found = matching.near(now, fragment, analysis::Partners::standing_first);
        return found.match.verdict == fit::FitVerdict::fit
                   ? std::optional(
                         candidate_of(*plan, matching, now, found, fit::Arrangement::none, analysis::MatchWay::near))
                   : std::nullopt;
    });
}

const FitCandidate* FragmentFits::near(int fragment) {
    if (looking_.is_ready()) try {
            // Where it is lost on the way to its place it stays known: nothing else has moved.
            if (auto found = looking_.take()) near_ = std::move(found);
        } catch (const std::exception& error) {
            problem_ = error.what();
        }
    return near_ && near_->step.fragment == fragment ? &*near_ : nullptr;
}

void FragmentFits::forget_near() {
    near_.reset();
    looking_.let_go();
}

}  // namespace tactus::window
