// SPDX-License-Identifier: Apache-2.0
#include "dsp/snap/fit.hpp"

#include "dsp/coupling/quasi_static.hpp"
#include "dsp/snap/hold.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus {

namespace {

constexpr int spins = 24;
constexpr std::size_t coarse_points = 160;  // of each side, about

struct Candidate {
    Pose pose;  // between centres
    double score = 0.0;
};

/// Springs that pull at nothing: the solver lowers the fit's energy alone.
QuasiStaticSettings free_solver(const FitSurface& moving) {
    QuasiStaticSettings s;
    s.springs = {{0.0, 1.0}, {0.0, 1.0}};
    s.iterations = 1;
    s.tolerance = 1e-7;
    s.reach = s.gyration = moving.gyration;
    return s;
}

/// `stages` steps while the scale narrows from `widest` to `finest`, weights looked at anew before each.
Pose anneal(FitEnergy& energy, const Pose& start, double widest, double finest, int stages, const FitSettings& settings,
            int& iterations) noexcept {
    QuasiStaticCoupling solver;
    solver.settings = free_solver(energy.moving());
    solver.reset(start);
    for (int stage = 0; stage < stages; ++stage) {
        const double progress = stages > 1 ? static_cast<double>(stage) / (stages - 1) : 1.0;
        energy.law.scale = widest * std::pow(finest / widest, progress);
        energy.law.power = 1.0 + (settings.power - 1.0) * progress;
        solver.settings.step = std::max(energy.law.scale, 0.3e-3);
        energy.look(solver.state().proxy);
        const Pose pose = solver.state().proxy;
        iterations += solver.update(pose, energy).iterations;
    }
    return solver.state().proxy;
}

/// At the fine scale until the steps are done.
Pose refine(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept {
    QuasiStaticCoupling solver;
    solver.settings = free_solver(energy.moving());
    solver.settings.step = 0.3e-3;
    solver.reset(start);
    energy.law.scale = settings.finest;
    energy.law.power = settings.power;
    for (int n = 0; n < 30; ++n) {
        const Pose before = solver.state().proxy;
        energy.look(before);
        const int steps = solver.update(before, energy).iterations;
        iterations += steps;
        const Vec3 turn = rotation_between(before.orientation, solver.state().proxy.orientation);
        const double way =
            glm::length(solver.state().proxy.position - before.position) + glm::length(turn) * energy.moving().gyration;
        if (steps == 0 || way < 1e-7) break;
    }
    return solver.state().proxy;
}

void set_law(FitEnergy& energy, const FitSettings& settings, bool coarse) {
    FitLaw& law = energy.law;
    law = {};
    law.reach = 1.0;
    law.outline = settings.outline;
    const std::size_t points = std::min(energy.moving().position.size(), energy.fixed().position.size());
    law.stride = coarse ? std::max<std::size_t>(1, points / coarse_points) : 1;
}

/// The shortest turn that takes direction `from` to `to`.
Quat shortest_turn(const Vec3& from, const Vec3& to) {
    const Vec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis), cosine = glm::dot(from, to);
    if (sine < 1e-9) {
        if (cosine > 0.0) return {1.0, 0.0, 0.0, 0.0};
        const Vec3 other = std::abs(from.x) < 0.5 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        return glm::angleAxis(std::numbers::pi, glm::normalize(glm::cross(from, other)));
    }
    return glm::angleAxis(std::atan2(sine, cosine), axis / sine);
}

Vec3 direction_of(const Vec3& normal) {
    const double length = glm::length(normal);
    return length > 1e-6 ? normal / length : Vec3(0.0, 0.0, 1.0);
}

/// The start, the same with the middles of the paints on each other and their normals opposed, and turns around that.
std::vector<Pose> starts_near(const FitSurface& moving, const FitSurface& fixed, const Pose& start) {
    std::vector<Pose> starts{start, {Vec3(0.0), start.orientation}};
    const Quat opposed =
        shortest_turn(start.rotate(direction_of(moving.mean_normal)), -direction_of(fixed.mean_normal)) *
        start.orientation;
    starts.push_back({Vec3(0.0), opposed});
    const Vec3 about = direction_of(fixed.mean_normal);
    for (const double spin : {-0.5, -0.25, 0.25, 0.5})
        starts.push_back({Vec3(0.0), glm::angleAxis(spin, about) * opposed});
    return starts;
}

std::vector<Pose> starts_everywhere(const FitSurface& moving, const FitSurface& fixed) {
    const Vec3 about = direction_of(fixed.mean_normal);
    const Quat opposed = shortest_turn(direction_of(moving.mean_normal), -about);
    std::vector<Pose> starts;
    for (int n = 0; n < spins; ++n)
        starts.push_back({Vec3(0.0), glm::angleAxis(2.0 * std::numbers::pi * n / spins, about) * opposed});
    return starts;
}

double apart(const Candidate& a, const Candidate& b, double gyration) {
    return glm::length(a.pose.position - b.pose.position) +
           gyration * glm::length(rotation_between(a.pose.orientation, b.pose.orientation));
}

/// Best first; of those within `nearer` of each other only the best stays.
void keep_distinct(std::vector<Candidate>& all, double gyration, double nearer) {
    std::ranges::stable_sort(all, std::ranges::greater{}, &Candidate::score);
    std::vector<Candidate> kept;
    for (const Candidate& c : all)
        if (std::ranges::none_of(kept, [&](const Candidate& k) { return apart(c, k, gyration) < nearer; }))
            kept.push_back(c);
    all = kept;
}

std::vector<Candidate> coarse(FitEnergy& energy, const std::vector<Pose>& starts, const FitSettings& settings,
                              int& iterations) {
    set_law(energy, settings, true);
    std::vector<Candidate> found;
    for (const Pose& start : starts) {
        const Pose pose = anneal(energy, start, settings.widest, 2.0 * settings.finest, 25, settings, iterations);
        found.push_back({pose, energy.quality(pose, 2.0 * settings.sigma).score});
    }
    keep_distinct(found, energy.moving().gyration, 1e-3);
    return found;
}

void fine(FitEnergy& energy, std::vector<Candidate>& candidates, std::size_t most, const FitSettings& settings,
          int& iterations) {
    set_law(energy, settings, false);
    if (candidates.size() > most) candidates.resize(most);
    for (Candidate& c : candidates) {
        c.pose = anneal(energy, c.pose, 4.0 * settings.finest, settings.finest, 10, settings, iterations);
        c.pose = refine(energy, c.pose, settings, iterations);
        c.score = energy.quality(c.pose, settings.sigma).score;
    }
    keep_distinct(candidates, energy.moving().gyration, 1e-3);
}

/// Thesis 6.1.2: pull of constant size, contact and the springs of a hand balance each millisecond; the hand gives way.
Pose follow_thesis(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept {
    energy.law = {};
    energy.law.kernel = FitKernel::steady;
    energy.law.strength = settings.pull;
    energy.law.two_sided = energy.law.gated = false;
    energy.law.contact = 10e3;
    QuasiStaticCoupling solver;
    solver.settings.reach = solver.settings.gyration = energy.moving().gyration;
    solver.reset(start);
    Pose hand = start;
    constexpr double follow = 1.0 / 50.0;
    for (int tick = 0; tick < 400; ++tick) {
        energy.look(solver.state().proxy);
        const QuasiStaticState& now = solver.update(hand, energy);
        iterations += now.iterations;
        hand.position += follow * (now.proxy.position - hand.position);
        hand.orientation = glm::normalize(
            rotation_by(follow * rotation_between(hand.orientation, now.proxy.orientation)) * hand.orientation);
    }
    return solver.state().proxy;
}

FitVerdict judge(const Fit& fit, const FitSettings& settings) {
    // Surfaces that do not belong together cross each other: what is near is spread evenly over all distances.
    if (fit.quality.score < settings.least_score || fit.quality.rms > settings.most_rms * settings.sigma)
        return FitVerdict::no_match;
    if (!fit.free.empty()) return FitVerdict::sliding;
    if (fit.margin < settings.least_margin) return FitVerdict::ambiguous;
    if (fit.quality.penetration > settings.most_penetration) return FitVerdict::blocked;
    return FitVerdict::fit;
}

}  // namespace

std::string_view name_of(FitVerdict verdict) {
    constexpr std::string_view names[] = {"fit", "sliding", "ambiguous", "no_match", "blocked"};
    return names[static_cast<std::size_t>(verdict)];
}

Pose between_centres(const FitSurface& moving, const FitSurface& fixed, const Pose& bodies) {
    return {bodies.apply(moving.centre) - fixed.centre, bodies.orientation};
}

Pose between_bodies(const FitSurface& moving, const FitSurface& fixed, const Pose& centres) {
    return {centres.position + fixed.centre - centres.orientation * moving.centre, centres.orientation};
}

Pose settle(FitEnergy& energy, const Pose& start, const FitSettings& settings, int* iterations) noexcept {
    set_law(energy, settings, false);
    int count = 0;
    const Pose pose = refine(energy, between_centres(energy.moving(), energy.fixed(), start), settings, count);
    if (iterations) *iterations += count;
    return between_bodies(energy.moving(), energy.fixed(), pose);
}

FitSettings settings_for(const FitSurface& moving, const FitSurface& fixed) {
    const auto coarsest = [](const Vec3& h) { return std::max({h.x, h.y, h.z}); };
    const double h = std::max(coarsest(moving.field.grid.spacing), coarsest(fixed.field.grid.spacing));
    FitSettings settings;
    settings.finest = std::max(settings.finest, 0.6 * h);
    settings.sigma = std::max(settings.sigma, 0.5 * h);
    return settings;
}

Fit find_fit(const FitSurface& moving, const FitSurface& fixed, const Pose& start, FitMode mode,
             const FitSettings& settings) {
    FitEnergy energy(moving, fixed);
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
            set_law(energy, settings, false);
            found[0].score = energy.quality(found[0].pose, settings.sigma).score;
        } else {
            found = coarse(energy, starts_near(moving, fixed, from), settings, fit.iterations);
            fine(energy, found, 3, settings, fit.iterations);
        }
        fine(energy, elsewhere, 3, settings, fit.iterations);
    }
    const Candidate best = found.front();
    double second = 0.0;
    for (const auto* list : {&found, &elsewhere})
        for (const Candidate& c : *list)
            if (apart(c, best, radius) > 1e-3) second = std::max(second, c.score);
    set_law(energy, settings, false);
    fit.quality = energy.quality(best.pose, settings.sigma);
    fit.margin = best.score > 0.0 ? std::clamp(1.0 - second / best.score, 0.0, 1.0) : 0.0;
    energy.law.scale = settings.finest;
    energy.law.power = settings.power;
    energy.look(best.pose);
    find_free(fit, energy(best.pose, ContactParts::all).stiffness, radius, settings.least_hold);
    fit.pose = between_bodies(moving, fixed, best.pose);
    fit.verdict = judge(fit, settings);
    return fit;
}

Fit find_fit(std::span<const FitSurface> moving, std::span<const FitSurface> fixed, const Pose& start, FitMode mode) {
    std::vector<Fit> fits;
    std::size_t best = 0;
    const FitSurface *moving_face = &moving.front(), *fixed_face = &fixed.front();
    for (const FitSurface& m : moving)
        for (const FitSurface& f : fixed) {
            fits.push_back(find_fit(m, f, start, mode, settings_for(m, f)));
            // The area that fits counts as well: a small patch finds its like on any large one.
            const auto worth = [](const Fit& fit) { return fit.quality.score * std::sqrt(fit.quality.overlap); };
            if (fits.size() > 1 && !(worth(fits.back()) > worth(fits[best]))) continue;
            best = fits.size() - 1;
            moving_face = &m;
            fixed_face = &f;
        }
    Fit fit = fits[best];
    const Candidate chosen{between_centres(*moving_face, *fixed_face, fit.pose), fit.quality.score};
    for (std::size_t n = 0; n < fits.size(); ++n) {
        fit.iterations += n == best ? 0 : fits[n].iterations;
        const Candidate other{between_centres(*moving_face, *fixed_face, fits[n].pose), 0.0};
        // Patches that fit by chance are small: they count by what they cover of the best one.
        const double area = std::min(1.0, fits[n].quality.overlap / std::max(fit.quality.overlap, 1e-12));
        if (n != best && apart(other, chosen, moving_face->gyration) > 1e-3 && fit.quality.score > 0.0)
            fit.margin = std::min(fit.margin, std::max(0.0, 1.0 - area * fits[n].quality.score / fit.quality.score));
    }
    fit.verdict = judge(fit, settings_for(*moving_face, *fixed_face));
    return fit;
}

}  // namespace tactus
