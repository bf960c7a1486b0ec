// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fragment_matcher.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/faces.hpp"
#include "dsp/fit/fit_steps.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::fit {

namespace {

constexpr int start_spins = 16;

/// One face as a surface of its own, with at most this many points.
FitSurface surface_of(const FragmentSurface& fragment, std::span<const std::size_t> face, std::size_t most) {
    FitSurfaceOptions options;
    options.reach = 6e-3;
    options.max_samples = 1'000'000;
    FitSurface made = make_fit_face(fragment.points, face, *fragment.distance, options);
    const std::size_t stride = (made.position.size() + most - 1) / most;
    if (stride < 2) return made;
    std::size_t kept = 0;
    double sum = 0.0;
    for (std::size_t n = 0; n < made.position.size(); n += stride, ++kept) {
        made.position[kept] = made.position[n];
        made.normal[kept] = made.normal[n];
        sum += made.share[kept] = made.share[n];
    }
    made.position.resize(kept);
    made.normal.resize(kept);
    made.share.resize(kept);
    for (double& share : made.share) share /= sum;
    return made;
}

}  // namespace

FragmentMatcher::FragmentMatcher(std::span<const FragmentSurface> fragments, const MatcherSettings& wanted)
    : settings(wanted) {
    const double polish = settings.fit.polish;
    for (const FragmentSurface& fragment : fragments)
        if (fragment.distance) widen_for(settings.fit, fragment.distance->spacing);
    settings.fit.polish = std::max(polish, 0.5 * settings.fit.polish);
    paint_.assign(fragments.size(), 0.0);
    for (std::size_t n = 0; n < fragments.size(); ++n)
        for (const auto& face : split_faces(fragments[n].points)) {
            if (face.size() < 40) continue;
            faces_.push_back({static_cast<int>(n), surface_of(fragments[n], face, settings.max_points)});
            paint_[n] += faces_.back().surface.area;
        }
    if (faces_.size() > settings.max_faces)
        throw Error(
            fmt::format("the fragments have {} painted faces and at most {} can be matched: paint less, or "
                        "leave out fragments",
                        faces_.size(), settings.max_faces));
    if (settings.healthy.side)
        for (const FragmentSurface& fragment : fragments) pulls_.emplace_back(fragment.points, settings.healthy);
    for (const Face& face : faces_) {
        max_face_points_ = std::max(max_face_points_, face.surface.position.size());
        max_outline_ = std::max(max_outline_, face.surface.outline.size());
    }
    const std::size_t joined = std::max<std::size_t>(settings.max_joined, 1);
    for (std::size_t n = 0; n < joined && !faces_.empty(); ++n) energies_.push_back(make_energy());
    pairs_.reserve(faces_.size() * faces_.size());
    joined_.reserve(joined);
    stood_.reserve(fragments.size());
    solved_.reserve(std::max<std::size_t>(settings.max_pairs, 1));
    free_.free.reserve(6);
}

FitEnergy& FragmentMatcher::energy(std::size_t slot, const Pair& pair) noexcept {
    FitEnergy& one = energies_[slot];
    one.rebind(faces_[pair.moving].surface, faces_[pair.fixed].surface);
    return one;
}

std::size_t FragmentMatcher::faces_of(int fragment) const noexcept {
    return static_cast<std::size_t>(
        std::ranges::count_if(faces_, [fragment](const Face& f) { return f.fragment == fragment; }));
}

Pose FragmentMatcher::world(const Pair& pair, const Pose& at, std::span<const Pose> poses) const noexcept {
    const Face& f = faces_[pair.fixed];
    return poses[static_cast<std::size_t>(f.fragment)] * between_bodies(faces_[pair.moving].surface, f.surface, at);
}

Pose FragmentMatcher::centres(const Pair& pair, const Pose& moving, std::span<const Pose> poses) const noexcept {
    const Face& f = faces_[pair.fixed];
    return between_centres(faces_[pair.moving].surface, f.surface,
                           poses[static_cast<std::size_t>(f.fragment)].inverse() * moving);
}

FitEnergy FragmentMatcher::make_energy() const {
    FitEnergy made(faces_.front().surface, faces_.front().surface);
    made.reserve(max_face_points_, max_outline_);
    made.law.kerf = settings.fit.kerf;
    return made;
}

FragmentMatcher::Solved FragmentMatcher::solve(FitEnergy& e, const Pair& pair, std::span<const Pose> starts,
                                               const Scales& scales) const noexcept {
    e.rebind(faces_[pair.moving].surface, faces_[pair.fixed].surface);
    const FitSettings& fit = settings.fit;
    const double gyration = e.moving().gyration;
    int steps = 0;
    std::array<Candidate, 2> best;
    set_law(e, 0.0, coarse_points);
    for (const Pose& start : starts) {
        const double finest = std::min(scales.widest, 2.0 * fit.finest);
        Candidate c{anneal(e, start, {scales.widest, finest, 24, fit.power}, steps), 0.0};
        c.score = e.quality(c.pose, 2.0 * fit.sigma).score;
        // Equal poses count once.
        if (best[0].score >= 0.0 && pose_distance(c.pose, best[0].pose, gyration) < 1e-3) {
            if (c.score > best[0].score) best[0] = c;
        } else if (c.score > best[0].score) best[1] = best[0], best[0] = c;
        else if (c.score > best[1].score) best[1] = c;
    }
    Solved solved{pair, {}, 0.0, {}};
    set_law(e, 0.0, settings.max_points);
    for (Candidate& c : best) {
        if (!(c.score >= 0.0)) continue;
        c.pose = anneal(e, c.pose, {scales.refined, fit.finest, 14, fit.power}, steps);
        c.score = e.quality(c.pose, fit.sigma).score;
        const bool is_apart = solved.best.score >= 0.0 && pose_distance(c.pose, solved.best.pose, gyration) > 1e-3;
        if (c.score > solved.best.score) {
            if (is_apart) solved.second = solved.best.score, solved.rival = solved.best.pose;
            solved.best = c;
        } else if (is_apart && c.score > solved.second) solved.second = c.score, solved.rival = c.pose;
    }
    return solved;
}

const FragmentMatch& FragmentMatcher::near(int moving, std::span<const Pose> poses,
                                           std::span<const char> stands) noexcept {
    match_ = {};
    match_.moving = moving;
    pairs_.clear();
    const Pose& held = poses[static_cast<std::size_t>(moving)];
    for (std::size_t m = 0; m < faces_.size(); ++m) {
        if (faces_[m].fragment != moving) continue;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const auto other = static_cast<std::size_t>(faces_[f].fragment);
            if (faces_[f].fragment == moving || !stands[other]) continue;
            const FitSurface &a = faces_[m].surface, &b = faces_[f].surface;
            const double facing = glm::dot(held.rotate(a.mean_normal), poses[other].rotate(b.mean_normal));
            const double away = glm::length(held.apply(a.centre) - poses[other].apply(b.centre));
            if (facing < -0.2 && away < settings.near) pairs_.push_back({m, f, away});
        }
    }
    std::ranges::sort(pairs_, [](const Pair& a, const Pair& b) {
        return a.distance != b.distance ? a.distance < b.distance
               : a.moving != b.moving   ? a.moving < b.moving
                                        : a.fixed < b.fixed;
    });
    solved_.clear();
    for (std::size_t n = 0; n < std::min({pairs_.size(), settings.max_pairs, solved_.capacity()}); ++n) {
        const Pair& pair = pairs_[n];
        const FitSurface &a = faces_[pair.moving].surface, &b = faces_[pair.fixed].surface;
        const Pose from = centres(pair, held, poses);
        const Vec3 about = direction_of(b.mean_normal);
        const Quat flat_on = opposed(a, b, from.orientation);
        // Starts: the present pose; centroids together; normals opposed; small rotations of these; and normals opposed
        // at the present position, also shifted, because centroids of partly overlapping faces do not coincide.
        const Vec3 beside = from.position - glm::dot(from.position, about) * about;
        const Vec3 across =
            glm::normalize(glm::cross(about, std::abs(about.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
        const Vec3 u = 2.5e-3 * across, v = 2.5e-3 * glm::cross(about, across);
        const std::array<Pose, 10> starts{{from,
                                           {Vec3(0.0), from.orientation},
                                           {Vec3(0.0), flat_on},
                                           {Vec3(0.0), glm::angleAxis(0.3, about) * flat_on},
                                           {Vec3(0.0), glm::angleAxis(-0.3, about) * flat_on},
                                           {beside, flat_on},
                                           {beside + u, flat_on},
                                           {beside - u, flat_on},
                                           {beside + v, flat_on},
                                           {beside - v, flat_on}}};
        solved_.push_back(solve(energies_[0], pair, starts, wide_scales()));
    }
    // In order of score; a chance fit far from where the fragment is held is not what the hand intends.
    const auto worth = [this](const Solved& s) {
        return s.best.score *
               std::sqrt(std::min(faces_[s.pair.moving].surface.area, faces_[s.pair.fixed].surface.area));
    };
    std::erase_if(solved_, [&](const Solved& s) {
        const Pose at = world(s.pair, s.best.pose, poses);
        const Vec3& centre = faces_[s.pair.moving].surface.centre;
        return glm::length(at.apply(centre) - held.apply(centre)) > settings.near ||
               glm::length(rotation_between(held.orientation, at.orientation)) > settings.max_turn;
    });
    std::ranges::sort(solved_, [&](const Solved& a, const Solved& b) { return worth(a) > worth(b); });
    FragmentMatch best = match_;
    for (std::size_t n = 0; n < std::min<std::size_t>(solved_.size(), 3); ++n) {
        match_ = {};
        match_.moving = moving;
        lead(solved_[n], poses, stands);
        if (is_in_doubt()) confirm(solved_[n], poses, stands);
        if (match_.verdict == FitVerdict::fit) return match_;
        // A chance fit of large faces may come before the right one of small faces.
        const bool is_better = match_.verdict == FitVerdict::uncertain && best.verdict != FitVerdict::uncertain;
        if (n == 0 || is_better) best = match_;
    }
    match_ = best;
    return match_;
}

/// No fit, but more than unrelated faces have in common.
bool FragmentMatcher::is_in_doubt() const noexcept {
    constexpr double related = 0.3;  // score; that of faces that do not belong together is up to 0.28
    return match_.verdict == FitVerdict::uncertain ||
           (match_.quality.score > related &&
            (match_.verdict == FitVerdict::no_match || match_.verdict == FitVerdict::blocked));
}

/// On chipped faces a wide scale leads past the right place into a wrong one, even from the right place itself. Searches
/// at narrow scales from scattered poses around the best place so far, each round narrower and with less scatter, find a
/// better place, or the rival that the bound must contain.
void FragmentMatcher::confirm(const Solved& best, std::span<const Pose> poses, std::span<const char> stands) noexcept {
    // Faces that meet all limits, but are too small for their noise, have hardly slipped.
    constexpr std::size_t max_scattered = 120, few = 30;
    const std::size_t scattered =
        match_.verdict == FitVerdict::uncertain && match_.quality.rms <= settings.fit.max_rms * settings.fit.sigma
            ? few
            : max_scattered;
    struct Round {
        double turn, slip;  // rad and m, half widths of the scatter
        double widest;  // in units of the finest scale
    };
    constexpr Round rounds[] = {{0.28, 2.0e-3, 4.0}, {0.2, 1.2e-3, 2.0}, {0.16, 1.0e-3, 1.0}, {0.08, 0.5e-3, 1.0}};
    const FitSurface& fixed = faces_[best.pair.fixed].surface;
    const Vec3 about = direction_of(fixed.mean_normal);
    const Vec3 u =
        glm::normalize(glm::cross(about, std::abs(about.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
    const Vec3 v = glm::cross(about, u);
    const double gyration = faces_[best.pair.moving].surface.gyration, finest = settings.fit.finest;
    Solved found = best;
    std::uint64_t drawn = 0;
    const auto within = [&drawn](double half) { return half * (2.0 * Random{1}.uniform(drawn++) - 1.0); };
    for (const Round& round : rounds) {
        const Pose at = found.best.pose;
        std::array<Pose, max_scattered + 1> starts;
        starts.front() = at;
        for (std::size_t n = 1; n <= scattered; ++n) {
            const double spin = within(round.turn), tilt_u = within(round.turn), tilt_v = within(round.turn);
            const Quat turn = rotation_by(spin * about + tilt_u * u + tilt_v * v);
            const double slip_u = within(round.slip), slip_v = within(round.slip);
            starts[n] = {turn * at.position + slip_u * u + slip_v * v, glm::normalize(turn * at.orientation)};
        }
        Solved again = solve(energies_[0], best.pair, std::span(starts).first(scattered + 1),
                             {round.widest * finest, 1.6 * finest});
        // What was found before is a rival now, or still the best.
        for (const Candidate& c : {found.best, Candidate{found.rival, found.second}}) {
            if (!(c.score > 0.0) || pose_distance(c.pose, again.best.pose, gyration) < 1e-3) continue;
            if (c.score > again.best.score) {
                again.second = again.best.score, again.rival = again.best.pose;
                again.best = c;
            } else if (c.score > again.second) again.second = c.score, again.rival = c.pose;
        }
        found = again;
    }
    lead(found, poses, stands, 1.0);
}

void FragmentMatcher::begin_search() noexcept {
    found_ = {};
    left_ = next_ = 0;
}

const FragmentMatch& FragmentMatcher::search(int moving, std::span<const Pose> poses,
                                             std::span<const char> stands) noexcept {
    if (!same_search(moving, stands)) {
        found_ = {};
        found_.moving = moving;
        next_ = 0;
        stood_.assign(stands.begin(), stands.end());
    }
    pairs_.clear();
    for (std::size_t m = 0; m < faces_.size(); ++m)
        for (std::size_t f = 0; f < faces_.size(); ++f)
            if (faces_[m].fragment == moving && faces_[f].fragment != moving &&
                stands[static_cast<std::size_t>(faces_[f].fragment)])
                pairs_.push_back({m, f, 0.0});
    if (pairs_.empty()) {
        left_ = 0;
        return found_;
    }
    next_ = std::min(next_, pairs_.size() - 1);
    const Pair pair = pairs_[next_++];
    left_ = pairs_.size() - next_;
    const FitSurface &a = faces_[pair.moving].surface, &b = faces_[pair.fixed].surface;
    const Vec3 about = direction_of(b.mean_normal);
    const Quat flat_on = opposed(a, b, {1.0, 0.0, 0.0, 0.0});
    std::array<Pose, start_spins> starts;
    for (int n = 0; n < start_spins; ++n)
        starts[static_cast<std::size_t>(n)] = {
            Vec3(0.0), glm::angleAxis(2.0 * std::numbers::pi * n / start_spins, about) * flat_on};
    solved_.clear();
    solved_.push_back(solve(energies_[0], pair, starts, wide_scales()));
    match_ = {};
    match_.moving = moving;
    lead(solved_.front(), poses, stands);
    if (is_in_doubt()) confirm(solved_.front(), poses, stands);
    const auto worth = [](const FragmentMatch& m) { return m.quality.score * std::sqrt(m.quality.overlap); };
    if (worth(match_) > worth(found_)) {
        found_ = match_;
        found_beside_ = poses[static_cast<std::size_t>(match_.partner)].inverse() * match_.pose;
    }
    // Its partner may have moved since.
    if (found_.partner != Arrangement::none)
        found_.pose = poses[static_cast<std::size_t>(found_.partner)] * found_beside_;
    return found_;
}

bool FragmentMatcher::same_search(int moving, std::span<const char> stands) noexcept {
    return left_ > 0 && found_.moving == moving && std::ranges::equal(stood_, stands);
}

}  // namespace tactus::fit
