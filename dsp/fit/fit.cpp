// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/constraint_analysis.hpp"
#include "dsp/fit/fit_steps.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::fit {

namespace {

constexpr int spins = 24;
constexpr std::size_t coarse_points = 160;  // per side, approximately

struct Candidate {
    Pose pose;  // between centres
    double score = 0.0;
};

/// Starts: the given pose, the same with centroids together and normals opposed, and rotations around that.
std::vector<Pose> starts_near(const FitSurface& moving, const FitSurface& fixed, const Pose& start) {
    std::vector<Pose> starts{start, {Vec3(0.0), start.orientation}};
    const Quat flat_on = opposed(moving, fixed, start.orientation);
    starts.push_back({Vec3(0.0), flat_on});
    const Vec3 about = direction_of(fixed.mean_normal);
    for (const double spin : {-0.5, -0.25, 0.25, 0.5})
        starts.push_back({Vec3(0.0), glm::angleAxis(spin, about) * flat_on});
    return starts;
}

std::vector<Pose> starts_everywhere(const FitSurface& moving, const FitSurface& fixed) {
    const Vec3 about = direction_of(fixed.mean_normal);
    const Quat flat_on = opposed(moving, fixed, {1.0, 0.0, 0.0, 0.0});
    std::vector<Pose> starts;
    for (int n = 0; n < spins; ++n)
        starts.push_back({Vec3(0.0), glm::angleAxis(2.0 * std::numbers::pi * n / spins, about) * flat_on});
    return starts;
}

/// Sorted best first; of those within `nearer` of each other only the best stays.
void keep_distinct(std::vector<Candidate>& all, double gyration, double nearer) {
    std::ranges::stable_sort(all, std::ranges::greater{}, &Candidate::score);
    std::vector<Candidate> kept;
    for (const Candidate& c : all)
        if (std::ranges::none_of(kept,
                                 [&](const Candidate& k) { return pose_distance(c.pose, k.pose, gyration) < nearer; }))
            kept.push_back(c);
    all = kept;
}

bool is_within_reach(const Pose& pose, const Pose& start, const FitSettings& settings) {
    return glm::length(pose.position - start.position) < settings.max_way &&
           glm::length(rotation_between(start.orientation, pose.orientation)) < settings.max_turn;
}

std::vector<Candidate> coarse(FitEnergy& energy, const std::vector<Pose>& starts, const FitSettings& settings,
                              int& iterations) {
    set_law(energy, settings.outline, coarse_points);
    std::vector<Candidate> found;
    for (const Pose& start : starts) {
        const Pose pose =
            anneal(energy, start, {settings.widest, 2.0 * settings.finest, 25, settings.power}, iterations);
        found.push_back({pose, energy.quality(pose, 2.0 * settings.sigma).score});
    }
    keep_distinct(found, energy.moving().gyration, 1e-3);
    return found;
}

void fine(FitEnergy& energy, std::vector<Candidate>& candidates, std::size_t most, const FitSettings& settings,
          int& iterations) {
    set_law(energy, settings.outline);
    if (candidates.size() > most) candidates.resize(most);
    for (Candidate& c : candidates) {
        c.pose = anneal(energy, c.pose, {4.0 * settings.finest, settings.finest, 10, settings.power}, iterations);
        c.pose = refine(energy, c.pose, settings, iterations);
        c.score = energy.quality(c.pose, settings.sigma).score;
    }
    keep_distinct(candidates, energy.moving().gyration, 1e-3);
}

/// Where the fit ends that starts from a slip along the face, to the next relief.
std::vector<Candidate> slips_of(FitEnergy& energy, const Pose& best, const FitSettings& settings, int& iterations) {
    constexpr int ways = 6;
    const Vec3 n = direction_of(energy.fixed().mean_normal);
    const Vec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
    const Vec3 v = glm::cross(n, u);
    set_law(energy, settings.outline, coarse_points);
    std::vector<Candidate> found;
    for (int way = 0; way < ways; ++way) {
        const double angle = 2.0 * std::numbers::pi * way / ways;
        const double away = way % 2 == 0 ? 2e-3 : 3.5e-3;
        const Pose start{best.position + away * (std::cos(angle) * u + std::sin(angle) * v), best.orientation};
        const Pose pose =
            anneal(energy, start, {4.0 * settings.finest, settings.finest, 12, settings.power}, iterations);
        found.push_back({pose, energy.quality(pose, settings.sigma).score});
    }
    return found;
}

/// Thesis 6.1.2: constant pull, contact and the springs of a hand are balanced each millisecond; the hand yields.
Pose follow_thesis(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept {
    energy.law = {};
    energy.law.kernel = FitKernel::steady;
    energy.law.strength = settings.pull;
    energy.law.two_sided = energy.law.gated = false;
    energy.law.contact = 10e3;
    coupling::QuasiStaticCoupling solver;
    solver.settings.reach = solver.settings.gyration = energy.moving().gyration;
    solver.reset(start);
    Pose hand = start;
    constexpr double follow = 1.0 / 50.0;
    for (int tick = 0; tick < 400; ++tick) {
        energy.look(solver.state().proxy);
        const coupling::QuasiStaticState& now = solver.update(hand, energy);
        iterations += now.iterations;
        hand.position += follow * (now.proxy.position - hand.position);
        hand.orientation = glm::normalize(
            rotation_by(follow * rotation_between(hand.orientation, now.proxy.orientation)) * hand.orientation);
    }
    return solver.state().proxy;
}

PoseBound wider(const PoseBound& a, const PoseBound& b) noexcept {
    return {std::max(a.turn, b.turn), std::max(a.face, b.face), std::max(a.far, b.far), a.has_rival || b.has_rival};
}

}  // namespace

std::string_view name_of(FitVerdict verdict) {
    constexpr std::string_view names[] = {"fit", "sliding", "ambiguous", "no_match", "blocked", "uncertain"};
    return names[static_cast<std::size_t>(verdict)];
}

FitVerdict judge(const FitQuality& quality, bool is_free, double margin, const FitSettings& settings,
                 double far) noexcept {
    const double min_score = settings.min_uncertain_score();
    // Unrelated surfaces cross each other: their nearby distances are spread evenly.
    const bool is_within = quality.score >= min_score && quality.share >= settings.min_share &&
                           quality.rms <= settings.max_rms * settings.sigma;
    const bool is_likely = quality.score >= std::max(Acceptance::likely_score, min_score) &&
                           quality.share >= settings.min_share && margin >= Acceptance::likely_margin &&
                           quality.rms <= Acceptance::likely_rms * settings.sigma;
    if (quality.overlap < settings.min_overlap || !(is_within || is_likely)) return FitVerdict::no_match;
    if (is_free) return FitVerdict::sliding;
    if (margin < settings.min_margin) return FitVerdict::ambiguous;
    if (quality.penetration > settings.max_penetration) return FitVerdict::blocked;
    const bool is_sharp = quality.score >= settings.min_fit_score();
    return is_within && is_sharp && far <= settings.max_far ? FitVerdict::fit : FitVerdict::uncertain;
}

std::string_view answer_of(FitVerdict verdict) {
    if (verdict == FitVerdict::fit) return "fit";
    return verdict == FitVerdict::uncertain ? "fit, uncertain" : "no match";
}

Pose between_centres(const FitSurface& moving, const FitSurface& fixed, const Pose& bodies) {
    return {bodies.apply(moving.centre) - fixed.centre, bodies.orientation};
}

Pose between_bodies(const FitSurface& moving, const FitSurface& fixed, const Pose& centres) {
    return {centres.position + fixed.centre - centres.orientation * moving.centre, centres.orientation};
}

Pose settle(FitEnergy& energy, const Pose& start, const FitSettings& settings, int* iterations) noexcept {
    set_law(energy, settings.outline);
    int count = 0;
    const Pose pose = refine(energy, between_centres(energy.moving(), energy.fixed(), start), settings, count);
    if (iterations) *iterations += count;
    return between_bodies(energy.moving(), energy.fixed(), pose);
}

void widen_for(FitSettings& settings, const Vec3& spacing) noexcept {
    const double h = std::max({spacing.x, spacing.y, spacing.z});
    settings.finest = std::max(settings.finest, 0.6 * h);
    settings.sigma = std::max(settings.sigma, 0.5 * h);
    settings.polish = std::max(settings.polish, 0.3 * h);
    settings.intact = std::max(settings.intact, 0.3 * h);
    // A few dozen voxels of any two surfaces coincide somewhere.
    settings.min_overlap = std::max(settings.min_overlap, 60.0 * h * h);
}

FitSettings settings_for(const FitSurface& moving, const FitSurface& fixed) {
    FitSettings settings;
    widen_for(settings, moving.field.grid.spacing);
    widen_for(settings, fixed.field.grid.spacing);
    return settings;
}

Fit find_fit(const FitSurface& moving, const FitSurface& fixed, const Pose& start, FitMode mode,
             const FitSettings& settings) {
    FitEnergy energy(moving, fixed);
    energy.law.kerf = settings.kerf;
    Fit fit;
    const Pose from = between_centres(moving, fixed, start);
    const double radius = moving.gyration;
    std::vector<Candidate> elsewhere = coarse(energy, starts_everywhere(moving, fixed), settings, fit.iterations);
    std::vector<Candidate> found;
    if (mode == FitMode::global) {
        fine(energy, elsewhere, 4, settings, fit.iterations);
        found = elsewhere;
    } else {
        if (mode == FitMode::thesis) {
            found = {{follow_thesis(energy, from, settings, fit.iterations), 0.0}};
            set_law(energy, settings.outline);
            found[0].score = energy.quality(found[0].pose, settings.sigma).score;
        } else {
            found = coarse(energy, starts_near(moving, fixed, from), settings, fit.iterations);
            // Results of the spins within reach of the start count as found from the start.
            for (const Candidate& c : elsewhere)
                if (is_within_reach(c.pose, from, settings)) found.push_back(c);
            keep_distinct(found, radius, 1e-3);
            fine(energy, found, 4, settings, fit.iterations);
        }
        fine(energy, elsewhere, 3, settings, fit.iterations);
    }
    const Candidate best = found.front();
    double second = 0.0;
    Pose rival = best.pose;
    for (const auto* list : {&found, &elsewhere})
        for (const Candidate& c : *list)
            if (pose_distance(c.pose, best.pose, radius) > 1e-3 && c.score > second) second = c.score, rival = c.pose;
    set_law(energy, settings.outline);
    fit.quality = energy.quality(best.pose, settings.sigma);
    fit.margin = best.score > 0.0 ? std::clamp(1.0 - second / best.score, 0.0, 1.0) : 0.0;
    set_robust(energy, settings, 1.0);
    energy.look(best.pose);
    find_free(fit, energy(best.pose, contact::ContactParts::all).stiffness, radius, settings.min_hold);
    fit.pose = between_bodies(moving, fixed, best.pose);
    FitPrecisionSum sum(best.pose.position, best.pose.apply(moving.far));
    sum.add(moving, fixed, {}, energy.closed(best.pose));
    fit.precision = sum.precision();
    const FitPrecision calibrated = sum.calibrated();
    fit.bound = bound_of(calibrated, fit.margin, best.pose, rival, Vec3(0.0), moving.far, false);
    for (const Candidate& c : slips_of(energy, best.pose, settings, fit.iterations))
        if (best.score > 0.0 && pose_distance(c.pose, best.pose, radius) > 1e-3)
            fit.bound = wider(fit.bound, bound_of(calibrated, std::max(0.0, 1.0 - c.score / best.score), best.pose,
                                                  c.pose, Vec3(0.0), moving.far, false));
    fit.verdict = judge(fit.quality, !fit.free.empty(), fit.margin, settings, fit.precision.far);
    return fit;
}

Fit find_fit(std::span<const FitSurface> moving, std::span<const FitSurface> fixed, const Pose& start, FitMode mode,
             double kerf) {
    std::vector<Fit> fits;
    std::size_t best = 0;
    for (std::size_t m = 0; m < moving.size(); ++m)
        for (std::size_t f = 0; f < fixed.size(); ++f) {
            FitSettings settings = settings_for(moving[m], fixed[f]);
            settings.kerf = kerf;
            fits.push_back(find_fit(moving[m], fixed[f], start, mode, settings));
            fits.back().moving_face = m;
            fits.back().fixed_face = f;
            // The fitted area is part of the score: a small patch finds a match on any large one.
            const auto worth = [](const Fit& fit) { return fit.quality.score * std::sqrt(fit.quality.overlap); };
            if (fits.size() > 1 && !(worth(fits.back()) > worth(fits[best]))) continue;
            best = fits.size() - 1;
        }
    Fit fit = fits[best];
    const FitSurface *moving_face = &moving[fit.moving_face], *fixed_face = &fixed[fit.fixed_face];
    const Pose chosen = between_centres(*moving_face, *fixed_face, fit.pose);
    for (std::size_t n = 0; n < fits.size(); ++n) {
        fit.iterations += n == best ? 0 : fits[n].iterations;
        const Pose other = between_centres(*moving_face, *fixed_face, fits[n].pose);
        // Patches that fit by chance are small: they are weighted by their overlap relative to the best one.
        const double area = std::min(1.0, fits[n].quality.overlap / std::max(fit.quality.overlap, 1e-12));
        if (n != best && pose_distance(other, chosen, moving_face->gyration) > 1e-3 && fit.quality.score > 0.0) {
            const double before = fit.margin;
            fit.margin = std::min(before, std::max(0.0, 1.0 - area * fits[n].quality.score / fit.quality.score));
            if (fit.margin < before)
                fit.bound =
                    wider(fit.bound, bound_of({}, fit.margin, chosen, other, Vec3(0.0), moving_face->far, false));
        }
    }
    fit.verdict =
        judge(fit.quality, !fit.free.empty(), fit.margin, settings_for(*moving_face, *fixed_face), fit.precision.far);
    return fit;
}

}  // namespace tactus::fit
