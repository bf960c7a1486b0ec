// SPDX-License-Identifier: Apache-2.0
// From the best pair of faces to the pose of the fragment: all faces that fit there are fitted together.
#include "dsp/fit/adjoint.hpp"
#include "dsp/fit/constraint_analysis.hpp"
#include "dsp/fit/fit_steps.hpp"
#include "dsp/fit/fragment_matcher.hpp"
#include "dsp/geometry/main_axes.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tactus::fit {

namespace {

constexpr double unequal = 0.8;  // of the areas: below it the middles of two faces that fit are apart

/// From the middle of a face to where the middle of a smaller one lies that fits its end, m, body frame. As of a strip of
/// constant width: the standard deviation along it is its length over √12.
Vec3 middle_at_end(const FitSurface& larger, const FitSurface& smaller) {
    Mat3 spread(0.0);
    for (std::size_t n = 0; n < larger.position.size(); ++n)
        spread += larger.share[n] * glm::outerProduct(larger.position[n], larger.position[n]);
    const Vec3 along = geometry::main_axes(spread)[0];
    const double deviation = std::sqrt(glm::dot(along, spread * along));
    return std::sqrt(3.0) * deviation * (1.0 - smaller.area / larger.area) * along;
}

/// The same starts with the smaller face at both ends of the larger one.
void add_starts_at_ends(std::vector<Pose>& starts, const FitSurface& moving, const FitSurface& fixed) {
    if (std::min(moving.area, fixed.area) > unequal * std::max(moving.area, fixed.area)) return;
    const bool is_fixed_larger = fixed.area > moving.area;
    const Vec3 end = is_fixed_larger ? middle_at_end(fixed, moving) : middle_at_end(moving, fixed);
    const std::size_t count = starts.size();
    for (std::size_t n = 0; n < count; ++n) {
        const Quat turn = starts[n].orientation;
        const Vec3 there = is_fixed_larger ? end : turn * end;
        starts.push_back({there, turn});
        starts.push_back({-there, turn});
    }
}

}  // namespace

/// The contact of several face pairs of one moving fragment, as a single contact for the solver; pair n uses energy n.
/// With a healthy side, its pull too.
/// The handle is at `centre` of the fragment, for any origin of its file.
class FragmentMatcher::Together {
public:
    Together(FragmentMatcher& matcher, std::span<const Pair> pairs, std::span<const Pose> poses, const Vec3& centre)
        : matcher_(matcher), pairs_(pairs), poses_(poses), centre_(centre) {}

    Pose handle(const Pose& body) const noexcept { return {body.apply(centre_), body.orientation}; }
    Pose body(const Pose& handle) const noexcept { return {handle.apply(-centre_), handle.orientation}; }

    void look(const Pose& at) noexcept {
        for (std::size_t n = 0; n < pairs_.size(); ++n)
            matcher_.energies_[n].look(matcher_.centres(pairs_[n], body(at), poses_));
        if (HealthyPull* pull = this->pull()) pull->look(body(at));
    }
    contact::ContactSum operator()(const Pose& at, contact::ContactParts parts) noexcept {
        contact::ContactSum all;
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            const Pair& pair = pairs_[k];
            const Face &m = matcher_.faces_[pair.moving], &f = matcher_.faces_[pair.fixed];
            const contact::ContactSum one = adjoint_transform(
                matcher_.energies_[k](matcher_.centres(pair, body(at), poses_), parts),
                glm::mat3_cast(poses_[static_cast<std::size_t>(f.fragment)].orientation),
                at.rotate(m.surface.centre - centre_), std::min(m.surface.area, f.surface.area) * 1e4);
            all.energy += one.energy;
            for (std::size_t n = 0; n < 6; ++n) all.gradient[n] += one.gradient[n];
            for (std::size_t n = 0; n < 36; ++n) all.stiffness[n] += one.stiffness[n];
        }
        if (const HealthyPull* pull = this->pull()) {
            const FitSurface& leading = matcher_.faces_[pairs_.front().moving].surface;
            pull->add(all, body(at), at.position, leading.area * 1e4 * matcher_.energies_[0].law.strength);
        }
        return all;
    }
    double clearance(const Pose&) const noexcept { return 0.0; }

private:
    HealthyPull* pull() const noexcept {
        if (matcher_.pulls_.empty()) return nullptr;
        return &matcher_.pulls_[static_cast<std::size_t>(matcher_.faces_[pairs_.front().moving].fragment)];
    }

    FragmentMatcher& matcher_;
    std::span<const Pair> pairs_;
    std::span<const Pose> poses_;
    Vec3 centre_;
};

void FragmentMatcher::join(const Solved& best, const Pose& at, std::span<const Pose> poses,
                           std::span<const char> stands) noexcept {
    joined_.clear();
    joined_.push_back(best.pair);
    for (std::size_t m = 0; m < faces_.size(); ++m)
        for (std::size_t f = 0; f < faces_.size() && joined_.size() < energies_.size(); ++f) {
            if (faces_[m].fragment != match_.moving || faces_[f].fragment == match_.moving ||
                !stands[static_cast<std::size_t>(faces_[f].fragment)] ||
                (m == best.pair.moving && f == best.pair.fixed))
                continue;
            const Pair pair{m, f, 0.0};
            const Pose there = centres(pair, at, poses);
            const double reach = faces_[m].surface.gyration + faces_[f].surface.gyration;
            if (glm::length(there.position) > reach) continue;
            FitEnergy& e = energy(0, pair);
            set_law(e, 0.0, coarse_points);
            if (e.quality(there, 1.5 * settings.fit.sigma).score > settings.min_share * best.best.score)
                joined_.push_back(pair);
        }
    match_.faces = static_cast<int>(joined_.size());
}

void FragmentMatcher::lead(const Solved& best, std::span<const Pose> poses, std::span<const char> stands,
                           double wider) noexcept {
    if (!(best.best.score > 0.0)) return;
    const FitSettings& fit = settings.fit;
    Pose at = world(best.pair, best.best.pose, poses);
    match_.partner = faces_[best.pair.fixed].fragment;
    // All faces that fit there take part.
    join(best, at, poses, stands);
    for (std::size_t n = 0; n < joined_.size(); ++n) set_law(energy(n, joined_[n]), 0.0, settings.max_points);
    const auto at_scale = [&](double scale) {
        for (std::size_t n = 0; n < joined_.size(); ++n) set_robust(energies_[n], fit, scale);
    };
    Together together(*this, joined_, poses, faces_[best.pair.moving].surface.centre);
    coupling::QuasiStaticCoupling solver;
    solver.settings = free_solver(faces_[best.pair.moving].surface.gyration);
    solver.settings.reach = 0.02;
    solver.settings.step = 0.3e-3;
    solver.reset(together.handle(at));
    const auto step = [&] {
        const Pose before = solver.state().proxy;
        together.look(before);
        return solver.update(before, together).iterations;
    };
    for (int stage = 0; stage < 18; ++stage) {
        at_scale(stage < 8 ? wider - 0.125 * (wider - 1.0) * stage : 1.0);
        if (step() == 0 && stage > 8) break;
    }
    const auto centres_of = [&](std::size_t k, const Pose& handle) {
        return centres(joined_[k], together.body(handle), poses);
    };
    Pose polished;
    for (int n = 1; n <= polish_steps; ++n) {
        if (n == first_intact_step) {
            polished = solver.state().proxy;
            for (std::size_t k = 0; k < joined_.size(); ++k) measure_noise(energies_[k], fit, centres_of(k, polished));
        }
        for (std::size_t k = 0; k < joined_.size(); ++k) set_polish(energies_[k], fit, n);
        step();
    }
    Pose there = solver.state().proxy;
    for (std::size_t k = 0; k < joined_.size(); ++k)
        if (is_astray(energies_[k], fit, centres_of(k, polished), centres_of(k, solver.state().proxy)))
            there = polished;
    at = together.body(there);
    match_.pose = at;
    at_scale(1.0);
    match_.quality = energies_[0].quality(centres(best.pair, at, poses), fit.sigma);
    match_.margin = match_.quality.score > 0.0 ? std::clamp(1.0 - best.second / match_.quality.score, 0.0, 1.0) : 0.0;
    free_.free.clear();
    together.look(there);
    find_free(free_, together(there, contact::ContactParts::all).stiffness, faces_[best.pair.moving].surface.gyration,
              fit.min_hold);
    const FitSurface& leading = faces_[best.pair.moving].surface;
    FitPrecisionSum sum(at.apply(leading.centre), at.apply(leading.centre + leading.far));
    for (std::size_t k = 0; k < joined_.size(); ++k) {
        const Face &m = faces_[joined_[k].moving], &f = faces_[joined_[k].fixed];
        const Pose& other = poses[static_cast<std::size_t>(f.fragment)];
        sum.add(m.surface, f.surface, {other.apply(f.surface.centre), other.orientation},
                energies_[k].closed(centres_of(k, there)));
    }
    match_.precision = sum.precision();
    match_.bound = bound_of(sum.calibrated(), match_.margin, centres(best.pair, at, poses), best.rival, Vec3(0.0),
                            leading.far, !pulls_.empty());
    // The healthy side holds the far end too.
    FitSettings required = fit;
    required.min_overlap = min_overlap(match_.moving, match_.partner);
    match_.verdict = judge(match_.quality, !free_.free.empty(), match_.margin, required,
                           pulls_.empty() ? match_.precision.far : 0.0);
}

double FragmentMatcher::min_overlap(int moving, int partner) const noexcept {
    const auto paint = [this](int n) { return paint_[static_cast<std::size_t>(n)]; };
    return std::max(settings.fit.min_overlap, Acceptance::min_paint_share * std::min(paint(moving), paint(partner)));
}

FacePairFit FragmentMatcher::fit_faces(FitEnergy& energy, std::size_t moving, std::size_t fixed,
                                       const Pose& held) const {
    constexpr int spins = 16;
    const FitSurface &a = faces_[moving].surface, &b = faces_[fixed].surface;
    const Vec3 about = direction_of(b.mean_normal);
    const Quat flat_on = opposed(a, b, {1.0, 0.0, 0.0, 0.0});
    std::vector<Pose> starts;
    for (int n = 0; n < spins; ++n)
        starts.push_back({Vec3(0.0), glm::angleAxis(2.0 * std::numbers::pi * n / spins, about) * flat_on});
    add_starts_at_ends(starts, a, b);
    const Pose from = between_centres(a, b, held);
    if (glm::length(from.position) < settings.near) {
        const Quat facing = opposed(a, b, from.orientation);
        const Vec3 beside = from.position - glm::dot(from.position, about) * about;
        starts.insert(starts.end(), {from, {Vec3(0.0), from.orientation}, {Vec3(0.0), facing}, {beside, facing}});
    }
    const Solved solved = solve(energy, {moving, fixed, 0.0}, starts, wide_scales());
    FacePairFit found{moving,        fixed, between_bodies(a, b, solved.best.pose), solved.best.score,
                      solved.second, 0.0,   between_bodies(a, b, solved.rival)};
    found.overlap = energy.quality(solved.best.pose, settings.fit.sigma).overlap;
    return found;
}

const FragmentMatch& FragmentMatcher::place(const FacePairFit& pair, std::span<const Pose> poses,
                                            std::span<const char> stands) noexcept {
    match_ = {};
    match_.moving = faces_[pair.moving].fragment;
    const FitSurface &a = faces_[pair.moving].surface, &b = faces_[pair.fixed].surface;
    const Pose at = between_centres(a, b, pair.pose), rival = between_centres(a, b, pair.rival);
    lead({{pair.moving, pair.fixed, 0.0}, {at, pair.score}, pair.second, rival}, poses, stands);
    return match_;
}

FitQuality FragmentMatcher::quality_of(FitEnergy& energy, std::size_t moving, std::size_t fixed,
                                       std::span<const Pose> poses) const {
    energy.rebind(faces_[moving].surface, faces_[fixed].surface);
    set_law(energy, 0.0);
    const Pose& body = poses[static_cast<std::size_t>(faces_[moving].fragment)];
    return energy.quality(centres({moving, fixed, 0.0}, body, poses), settings.fit.sigma);
}

}  // namespace tactus::fit
