// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/kerf_check.hpp"

#include "dsp/fit/fit_energy.hpp"
#include "dsp/fit/fit_precision.hpp"
#include "dsp/geometry/dense_cholesky.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace tactus::fit {

namespace {

constexpr double rim = 1.2e-3;  // m: nearer to the face the cortex is rounded
// m: length of a strip on either half. The error that a parabola makes of a curved cortex grows with its third power, and
// the noise of the step falls with it.
constexpr double short_reach = 5e-3, middle_reach = 7e-3, long_reach = 9e-3;
constexpr double half_width = 1.5e-3;  // m, of a strip
constexpr double alike = 0.8;  // least cosine between the normals of a strip
constexpr std::size_t max_strips = 48, min_in_strip = 12, max_paint = 400, max_centres = 200;
constexpr int independent = 8;  // strips around a bone that tell something of their own
constexpr double widest = 6e-3;  // m: errors of the opening that are still seen
constexpr double max_error = 0.5e-3;  // m, of the opening
constexpr double max_spread = 1e-3;  // m: what a contour says that knows less must be sure
// Of the standard deviation. Measured, not derived: with `tactus-bench shafts --count 20`, with and without chips, none of
// 40 that had lost 0.8 mm passed; of 40 whole ones with chips, none was refused for a kerf.
constexpr double share_of_spread = 0.5;
constexpr double nearby = 3e-3;  // m: relief is measured about surfaces through the points within this distance
constexpr double max_touch = 1e-3;  // m: farther from each other, faces do not touch
constexpr double flat_relief = 0.1e-3;  // m rms, shared
// Of the relief along the direction of the most: sawn waves share up to 0.23 of it, the shafts of `tactus-bench shafts` from
// 0.38 on.
constexpr double ruled_share = 0.3;
constexpr double flat_loss =
    3e-3;  // m: 95 % of losses that are exponentially distributed around 1 mm, the width of a blade

struct Spot {
    Vec3 at, normal;
};

/// The cortex around a face but for its rim, in the fixed frame.
std::vector<Spot> cortex_of(const KerfSide& side, const Pose& pose) {
    const FitSurface& face = *side.face;
    const std::size_t stride = 1 + face.position.size() / max_paint;
    double radius = 0.0;
    for (const Vec3& p : face.position) radius = std::max(radius, glm::length(p));
    radius += long_reach + rim;
    std::vector<Spot> spots;
    for (const contact::SurfacePoint& point : side.points) {
        const Vec3 p = point.position - face.centre;
        if (point.label == contact::surface_label::fracture || point.label == contact::surface_label::as_scanned ||
            !(glm::dot(p, p) < radius * radius) || !(glm::length(point.normal) > 0.5))
            continue;
        bool is_rim = false;
        for (std::size_t n = 0; n < face.position.size() && !is_rim; n += stride) {
            const Vec3 off = p - face.position[n];
            is_rim = glm::dot(off, off) < rim * rim;
        }
        if (!is_rim) spots.push_back({pose.apply(point.position), pose.rotate(glm::normalize(point.normal))});
    }
    return spots;
}

constexpr std::size_t unknowns = 7;  // the opening, and the error of the fit's pose as a twist
using Row = std::array<double, unknowns>;

/// m; by how much the step grows with the unknowns.
struct Step {
    double step;
    Row slope;

    double lever() const noexcept { return slope[0]; }
};

/// The step of one strip across the gap, `reach` long on either half: height over the tangent plane is a parabola, and a
/// step between the halves.
std::optional<Step> step_at(const Vec3& at, const Vec3& out, const Vec3& normal, const Vec3& origin,
                            const std::array<const std::vector<Spot>*, 2>& cortex, double reach) {
    constexpr std::size_t terms = 6;  // 1, z, z², t, t², step
    const Vec3 across = normal - glm::dot(normal, out) * out;
    if (!(glm::length(across) > 0.5)) return std::nullopt;
    const Vec3 along = glm::normalize(across), aside = glm::cross(out, along);
    std::vector<double> matrix(terms * terms, 0.0), solved(terms, 0.0);
    for (std::size_t half = 0; half < 2; ++half) {
        // An error of the opening lifts the moving half by its share along `out`.
        const double highest = 2e-3 + (half == 0 ? widest * std::abs(glm::dot(normal, out)) : 0.0);
        std::size_t count = 0;
        for (const Spot& spot : *cortex[half]) {
            const Vec3 off = spot.at - at;
            const double t = glm::dot(off, aside) / half_width, z = glm::dot(off, along) / reach;
            const double height = glm::dot(off, out);
            if (!(std::abs(t) < 1.0) || !(std::abs(z) < 1.4) || !(std::abs(height) < highest) ||
                !(glm::dot(spot.normal, out) > alike))
                continue;
            ++count;
            const double row[terms] = {1.0, z, z * z, t, t * t, half == 0 ? 0.5 : -0.5};
            for (std::size_t a = 0; a < terms; ++a) {
                solved[a] += row[a] * height;
                for (std::size_t b = 0; b < terms; ++b) matrix[a * terms + b] += row[a] * row[b];
            }
        }
        if (count < min_in_strip) return std::nullopt;
    }
    for (std::size_t a = 0; a < terms; ++a) matrix[a * terms + a] += 1e-9;
    if (!geometry::solve_positive(matrix, solved)) return std::nullopt;
    const Vec3 lifts = out - solved[1] / reach * along;
    const Vec3 turns = glm::cross(at - origin, lifts) / FitPrecisionSum::lever;
    return Step{solved[5], {glm::dot(normal, lifts), lifts.x, lifts.y, lifts.z, turns.x, turns.y, turns.z}};
}

struct Opening {
    double excess = 0.0, spread = 1.0;  ///< m
    double misfit = std::numeric_limits<double>::infinity();
};

/// The opening and the error of the pose that explain the steps best, where the faces hold the pose with `held`, an
/// inverse covariance. Strips over ridges and holes have steps of their own: their weight falls with the step that is left.
Opening opening_from(double excess, const std::vector<Step>& steps, std::span<const double, 36> held) {
    constexpr double usual = 0.2e-3;  // m, a step that is left
    Row at{excess};
    const auto left = [&at](const Step& s) {
        double off = s.step;
        for (std::size_t a = 0; a < unknowns; ++a) off -= s.slope[a] * at[a];
        return off;
    };
    Opening found{excess, 1.0, 0.0};
    for (int pass = 0; pass < 6; ++pass) {
        std::vector<double> matrix(unknowns * unknowns, 0.0), solved(unknowns, 0.0);
        double weights = 0.0, squares = 0.0;
        for (const Step& s : steps) {
            const double off = left(s) / usual, weight = 1.0 / (1.0 + off * off);
            weights += weight;
            squares += weight * off * off * usual * usual;
            for (std::size_t a = 0; a < unknowns; ++a) {
                solved[a] += weight * s.slope[a] * s.step;
                for (std::size_t b = 0; b < unknowns; ++b) matrix[a * unknowns + b] += weight * s.slope[a] * s.slope[b];
            }
        }
        if (!(weights > 0.0)) return {};
        // Strips are correlated: all together count as `independent` ones.
        const double information = independent / (weights * std::max(squares / weights, 1e-14));
        for (double& m : matrix) m *= information;
        for (double& m : solved) m *= information;
        for (std::size_t a = 0; a < 6; ++a)
            for (std::size_t b = 0; b < 6; ++b) matrix[(a + 1) * unknowns + b + 1] += held[6 * a + b];
        matrix[0] += 1.0;  // an opening of a metre is not excluded
        std::vector<double> variance(unknowns, 0.0), same = matrix;
        variance[0] = 1.0;
        if (!geometry::solve_positive(matrix, solved) || !geometry::solve_positive(same, variance)) return {};
        std::ranges::copy(solved, at.begin());
        found.excess = solved[0];
        found.spread = std::sqrt(variance[0]);
    }
    for (const Step& s : steps) found.misfit += std::log1p(left(s) * left(s) / (usual * usual));
    return found;
}

/// Median of the openings from single strips, weighted by their levers.
double middle_opening(std::vector<Step> steps) {
    std::erase_if(steps, [](const Step& s) { return !(std::abs(s.lever()) > 0.1); });
    std::ranges::sort(steps, {}, [](const Step& s) { return s.step / s.lever(); });
    double all = 0.0, below = 0.0;
    for (const Step& s : steps) all += std::abs(s.lever());
    for (const Step& s : steps)
        if ((below += std::abs(s.lever())) >= 0.5 * all) return s.step / s.lever();
    return 0.0;
}

}  // namespace

ContourOpening contour_opening(const KerfSide& moving, const KerfSide& fixed, const Pose& pose,
                               std::optional<double> given) {
    const Vec3 normal = opening_direction(*moving.face, *fixed.face, pose);
    const std::vector<Spot> mine = cortex_of(moving, pose), other = cortex_of(fixed, {});
    const FitSurface& face = *fixed.face;
    FitEnergy energy(*moving.face, face);
    energy.law.kerf = given.value_or(0.0);
    FitPrecisionSum held(face.centre, face.centre);
    held.add(*moving.face, face, {face.centre, {1.0, 0.0, 0.0, 0.0}},
             energy.closed({pose.apply(moving.face->centre) - face.centre, pose.orientation}));
    const auto opening_of = [&](double reach) {
        ContourOpening seen;
        std::vector<Step> steps;
        const std::size_t stride = 1 + face.outline.size() / max_strips;
        for (std::size_t n = 0; n < face.outline.size(); n += stride)
            if (const auto step = step_at(face.centre + face.outline[n], face.outline_normal[n], normal, face.centre,
                                          {&mine, &other}, reach))
                steps.push_back(*step);
        seen.strips = static_cast<int>(steps.size());
        if (seen.strips < independent) return seen;
        // Two starts, no error and the median of the strips: a local search from 0 does not reach an error of millimetres.
        const Opening near = opening_from(0.0, steps, held.information()),
                      far = opening_from(middle_opening(steps), steps, held.information());
        const Opening& best = far.misfit < near.misfit ? far : near;
        seen.excess = best.excess;
        seen.spread = best.spread;
        return seen;
    };
    // Only long strips, which have the least noise, may contradict a given kerf.
    if (given) return opening_of(long_reach);
    ContourOpening found = opening_of(short_reach);
    // Where short strips are too few, or their noise is a large opening, curvature is not what matters.
    if (found.strips < independent || found.spread > max_spread) return opening_of(long_reach);
    // Where parabolas of two lengths disagree, the cortex is none. By the third power, the shorter is wrong by 0.6 of the
    // difference; over 77 breaks in place of jaws, fibulas and a tibia, all of it made the error 0.98 of what is stated (rms).
    const ContourOpening middle = opening_of(middle_reach);
    if (middle.strips >= independent) found.spread = std::hypot(found.spread, found.excess - middle.excess);
    return found;
}

namespace {

/// A point of the moving face: its place in the opening's plane in units of `nearby`, its height along the opening, and
/// that of the fixed face below it.
struct Touch {
    double u, v, own, other;
};

/// The points of the moving face that lie on the fixed one.
std::vector<Touch> touches_of(const FitSurface& moving, const FitSurface& fixed, const Pose& pose) {
    const Vec3 normal = opening_direction(moving, fixed, pose);
    const Vec3 any = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(normal, any)), v = glm::cross(normal, u);
    const Pose into = between_centres(moving, fixed, pose);
    std::vector<Touch> touches;
    for (const Vec3& position : moving.position) {
        const Vec3 p = into.apply(position);
        const volume::Sample gap = fixed.field.sample(p);
        if (!gap.inside || !(std::abs(gap.value) < max_touch) || !fixed.is_painted_near(p)) continue;
        const double height = glm::dot(p, normal);
        touches.push_back({glm::dot(p, u) / nearby, glm::dot(p, v) / nearby, height, height - gap.value});
    }
    return touches;
}

/// The covariance of the heights of both faces about the surface of least squares with so many terms.
template <std::size_t terms>
class SharedHeights {
public:
    void add(const std::array<double, terms>& row, double mine, double its) {
        ++count_;
        products_ += mine * its;
        for (std::size_t a = 0; a < terms; ++a) {
            own_[a] += row[a] * mine;
            other_[a] += row[a] * its;
            for (std::size_t b = 0; b < terms; ++b) matrix_[a * terms + b] += row[a] * row[b];
        }
    }
    /// m²; none for fewer points than `min_count`.
    std::optional<double> covariance(std::size_t min_count) const {
        if (count_ < min_count) return std::nullopt;
        std::vector<double> matrix = matrix_, surface = own_;
        for (std::size_t a = 0; a < terms; ++a) matrix[a * terms + a] += 1e-9;
        if (!geometry::solve_positive(matrix, surface)) return std::nullopt;
        double products = products_;
        for (std::size_t a = 0; a < terms; ++a) products -= surface[a] * other_[a];
        return products / static_cast<double>(count_ - terms);
    }

private:
    std::vector<double> matrix_ = std::vector<double>(terms * terms, 0.0), own_ = std::vector<double>(terms, 0.0),
                        other_ = own_;
    double products_ = 0.0;
    std::size_t count_ = 0;
};

/// The covariance of both heights about planes through the points within `reach` (of `nearby`) of one, m². None for too few
/// points.
std::optional<double> covariance_around(const Touch& centre, const std::vector<Touch>& touches, double reach) {
    SharedHeights<3> heights;
    for (const Touch& t : touches) {
        const double u = t.u - centre.u, v = t.v - centre.v;
        if (u * u + v * v < reach * reach) heights.add({1.0, u, v}, t.own - centre.own, t.other - centre.own);
    }
    return heights.covariance(10);
}

/// The covariance of both heights about surfaces that are straight along `direction` (rad, in the opening's plane): of the
/// points within `reach` (of `nearby`) along it, and a quarter of that across. None for too few points.
std::optional<double> covariance_along(double direction, const Touch& centre, const std::vector<Touch>& around,
                                       double reach) {
    SharedHeights<6> heights;  // a ruled surface, to the third order across
    const double cosine = std::cos(direction), sine = std::sin(direction);
    for (const Touch& t : around) {
        const double u = (t.u - centre.u) / reach, v = (t.v - centre.v) / reach;
        const double along = u * cosine + v * sine, across = 4.0 * (v * cosine - u * sine);
        if (!(std::abs(along) < 1.0) || !(std::abs(across) < 1.0)) continue;
        heights.add({1.0, along, across, along * across, across * across, across * across * across}, t.own - centre.own,
                    t.other - centre.own);
    }
    return heights.covariance(12);
}

/// m rms: relief that both faces share, about planes, and about ruled surfaces along the directions in which they share
/// least and most.
struct SharedRelief {
    double about_planes = 0.0, least = 0.0, most = 0.0;

    bool is_sawn() const { return about_planes < flat_relief || least < ruled_share * most; }
};

SharedRelief shared_relief(const FitSurface& moving, const FitSurface& fixed, const Pose& pose) {
    constexpr std::size_t directions = 24;
    const std::vector<Touch> touches = touches_of(moving, fixed, pose);
    const std::size_t stride = 1 + touches.size() / max_centres;
    // Sparse points, as of a wide pointshell, need more room.
    for (const double reach : {1.0, 1.7}) {
        std::array<double, directions> sum{}, count{};
        double planes = 0.0, plane_count = 0.0;
        std::vector<Touch> around;
        for (std::size_t n = 0; n < touches.size(); n += stride) {
            const Touch& centre = touches[n];
            around.clear();
            for (const Touch& t : touches)
                if (std::hypot(t.u - centre.u, t.v - centre.v) < 1.1 * reach) around.push_back(t);
            if (const auto covariance = covariance_around(centre, around, reach))
                planes += *covariance, plane_count += 1.0;
            for (std::size_t d = 0; d < directions; ++d)
                if (const auto covariance = covariance_along(static_cast<double>(d) * std::numbers::pi / directions,
                                                             centre, around, reach)) {
                    sum[d] += *covariance;
                    count[d] += 1.0;
                }
        }
        double least = std::numeric_limits<double>::infinity(), most = 0.0;
        for (std::size_t d = 0; d < directions; ++d)
            if (count[d] > 0.0) {
                least = std::min(least, sum[d] / count[d]);
                most = std::max(most, sum[d] / count[d]);
            }
        if (plane_count > 0.0)
            return {std::sqrt(std::max(0.0, planes / plane_count)), std::sqrt(std::clamp(least, 0.0, most)),
                    std::sqrt(most)};
    }
    return {};
}

}  // namespace

KerfEstimate check_kerf(const KerfSide& moving, const KerfSide& fixed, const Pose& pose, std::optional<double> given) {
    KerfEstimate made;
    made.given = given;
    if (given == 0.0) return made;
    const double left = given.value_or(0.0);
    const ContourOpening contour = contour_opening(moving, fixed, pose, given);
    made.contour = contour;
    const Vec3 mean = 0.5 * (fixed.face->mean_normal - pose.rotate(moving.face->mean_normal));
    const double cosine = std::clamp(glm::length(mean), 0.5, 1.0), missing = -contour.excess;
    made.kerf = std::max(0.0, left + missing * cosine);
    made.spread = contour.spread * cosine;
    if (given) {
        const double limit = contour.spread < max_spread ? max_error : 2.0 * contour.spread;
        made.is_contradicted = std::abs(missing) > limit;
        made.is_too_wide = left * (1.0 / cosine - 1.0) > max_error;
    } else {
        // Without lost bone, faces touch whatever the contour beside them: ridges that end there also cause steps, which
        // `spread` includes. Touching faces are not too far apart: an estimate of that is wrong by at least as much.
        const double seen = std::max(0.0, missing), spread = std::hypot(contour.spread, seen - missing);
        const double doubt = share_of_spread * spread;
        const bool has_contour = contour.strips >= independent;
        made.is_contradicted = has_contour && missing > std::max(max_error, doubt);
        made.is_flat = shared_relief(*moving.face, *fixed.face, pose).is_sawn();
        if (has_contour && seen + doubt > max_error) made.loss = seen + 2.0 * spread;
        if (made.is_flat) made.loss = std::max(made.loss, flat_loss);
        made.is_open = !made.is_contradicted && made.loss > 0.0;
    }
    return made;
}

FitVerdict include_kerf(const KerfEstimate& kerf, FitVerdict verdict, PoseBound& bound) noexcept {
    if (verdict != FitVerdict::fit && verdict != FitVerdict::uncertain) return verdict;
    bound.face = std::hypot(bound.face, kerf.loss);
    bound.far = std::hypot(bound.far, kerf.loss);
    const bool is_refused = kerf.is_contradicted || kerf.is_too_wide;
    if (is_refused && (kerf.given || verdict == FitVerdict::fit)) return FitVerdict::ambiguous;
    return kerf.is_open ? FitVerdict::uncertain : verdict;
}

CommonOpening common_opening(std::span<const ContourOpening> pairs) noexcept {
    CommonOpening all;
    const auto mean_with = [&pairs](double variance) {
        double weights = 0.0, sum = 0.0, squares = 0.0;
        for (const ContourOpening& one : pairs) {
            if (one.strips < independent) continue;
            const double weight = 1.0 / (one.spread * one.spread + variance);
            weights += weight;
            squares += weight * weight;
            sum -= weight * one.excess;
        }
        return std::array{sum / weights, weights, squares};
    };
    all.pairs = static_cast<int>(
        std::ranges::count_if(pairs, [](const ContourOpening& one) { return one.strips >= independent; }));
    if (all.pairs == 0) return all;
    const auto [mean, weights, squares] = mean_with(0.0);
    double misfit = 1.0 - all.pairs;
    for (const ContourOpening& one : pairs)
        if (one.strips >= independent) misfit += std::pow((one.excess + mean) / one.spread, 2.0);
    const double free = weights - squares / weights;
    if (misfit > 0.0 && free > 0.0) all.scatter = std::sqrt(misfit / free);
    const auto scattered = mean_with(all.scatter * all.scatter);
    all.missing = scattered[0];
    all.spread = std::sqrt(1.0 / scattered[1]);
    return all;
}

bool CommonOpening::excludes_kerf(const ContourOpening& pair) const noexcept {
    if (pairs < 3 || pair.strips < independent) return false;
    const double prior = scatter * scatter + spread * spread, own = pair.spread * pair.spread;
    // The others are no evidence for a pair that contradicts them.
    if (-pair.excess - missing > 2.0 * std::sqrt(own + prior)) return false;
    const double mean = (missing * own - pair.excess * prior) / (own + prior);
    return mean + std::sqrt(own * prior / (own + prior)) < max_error;
}

}  // namespace tactus::fit
