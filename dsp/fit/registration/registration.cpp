// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/registration.hpp"

#include "dsp/contact/neighbours.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/geometry/main_axes.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::fit {

namespace {

constexpr double min_cosine = 0.5;

std::vector<Vec3> positions_of(std::span<const contact::SurfacePoint> points) {
    std::vector<Vec3> positions;
    positions.reserve(points.size());
    for (const contact::SurfacePoint& p : points) positions.push_back(p.position);
    return positions;
}

struct Spread {
    Vec3 middle{0.0};
    Mat3 axes{1.0};  ///< columns, longest first
    double gyration = 0.0;
};

/// Centroid and principal axes of the surface.
Spread spread_of(std::span<const contact::SurfacePoint> points) {
    Spread spread;
    double area = 0.0;
    for (const contact::SurfacePoint& p : points) spread.middle += p.area * p.position, area += p.area;
    spread.middle /= area;
    Mat3 m(0.0);
    for (const contact::SurfacePoint& p : points) {
        const Vec3 r = p.position - spread.middle;
        m += p.area / area * glm::outerProduct(r, r);
    }
    spread.gyration = std::sqrt(m[0][0] + m[1][1] + m[2][2]);
    spread.axes = geometry::main_axes(m);
    return spread;
}

std::vector<contact::SurfacePoint> thinned(std::span<const contact::SurfacePoint> points, std::size_t most) {
    const std::size_t stride = std::max<std::size_t>(1, (points.size() + most - 1) / most);
    std::vector<contact::SurfacePoint> some;
    for (std::size_t n = 0; n < points.size(); n += stride) some.push_back(points[n]);
    return some;
}

/// Distances of all points from the surface, ascending.
std::vector<double> distances(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                              const Pose& pose) {
    std::vector<double> all;
    for (const contact::SurfacePoint& p : moving) all.push_back(fixed.distance(pose.apply(p.position)));
    std::ranges::sort(all);
    return all;
}

void judge(Registration& result, std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
           const Pose& start, double scale) {
    const std::vector<double> all = distances(moving, fixed, result.pose);
    result.before = median_distance(moving, fixed, start);
    result.median = all[all.size() / 2];
    result.p90 = all[all.size() * 9 / 10];
    const auto near = std::ranges::lower_bound(all, 2.0 * scale) - all.begin();
    result.covered = static_cast<double>(near) / static_cast<double>(all.size());
}

Pose anneal(const std::vector<contact::SurfacePoint>& moving, const RegistrationTarget& fixed, const Pose& start,
            const RegistrationSettings& settings) {
    const Spread spread = spread_of(moving);
    Pose pose = start;
    // A pose changes little in a step: the last target of a point is a good guess of the next.
    std::vector<std::size_t> last(moving.size(), std::numeric_limits<std::size_t>::max());
    for (int stage = 0; stage < settings.stages + 20; ++stage) {
        const double progress = std::min(1.0, static_cast<double>(stage) / std::max(1, settings.stages - 1));
        const double s = settings.widest * std::pow(settings.finest / settings.widest, progress);
        const Vec3 centre = pose.apply(spread.middle);
        geometry::Matrix6 k{};
        geometry::Vector6 push{}, step{};
        for (std::size_t i = 0; i < moving.size(); ++i) {
            const contact::SurfacePoint& p = moving[i];
            const Vec3 x = pose.apply(p.position);
            const std::size_t to = last[i] = fixed.nearest(x, last[i]);
            const Vec3& n = fixed.normal(to);
            const double facing = glm::dot(pose.rotate(p.normal), n);
            if (!(facing > min_cosine)) continue;
            const Vec3 difference = x - fixed.position(to);
            const double squares = glm::dot(difference, difference), kernel = s * s / (s * s + squares);
            const double weight = p.area * facing * kernel * kernel, d = glm::dot(n, difference);
            const Vec3 lever = glm::cross(x - centre, n);
            const double row[6] = {n.x, n.y, n.z, lever.x, lever.y, lever.z};
            for (std::size_t a = 0; a < 6; ++a) {
                push[a] -= weight * d * row[a];
                for (std::size_t b = 0; b < 6; ++b) k[6 * a + b] += weight * row[a] * row[b];
            }
        }
        // Scaled so that the solver's regularisation is negligible.
        double greatest = 0.0;
        for (std::size_t a = 0; a < 3; ++a) greatest = std::max(greatest, k[7 * a]);
        if (!(greatest > 0.0)) break;
        for (double& entry : k) entry *= 1e6 / greatest;
        for (double& entry : push) entry *= 1e6 / greatest;
        if (!geometry::solve_symmetric6(k, push, step)) break;
        const Vec3 translation(step[0], step[1], step[2]), rotation(step[3], step[4], step[5]);
        const Quat spin = rotation_by(rotation);
        pose = {centre + translation + spin * (pose.position - centre), glm::normalize(spin * pose.orientation)};
        if (stage > settings.stages && glm::length(translation) + glm::length(rotation) * spread.gyration < 1e-8) break;
    }
    return pose;
}

/// Coverage of the target: mean of exp(−d² / 2s²).
double lies_on(const std::vector<contact::SurfacePoint>& points, const RegistrationTarget& fixed, const Pose& pose,
               double s) {
    double sum = 0.0, area = 0.0;
    for (const contact::SurfacePoint& p : points) {
        const double d = fixed.distance(pose.apply(p.position));
        sum += p.area * std::exp(-0.5 * d * d / (s * s));
        area += p.area;
    }
    return sum / area;
}

/// The eight octants of a surface about its centroid, along its principal axes.
std::array<std::vector<contact::SurfacePoint>, 8> parts_of(const std::vector<contact::SurfacePoint>& points) {
    const Spread spread = spread_of(points);
    std::array<std::vector<contact::SurfacePoint>, 8> parts;
    for (const contact::SurfacePoint& p : points) {
        const Vec3 r = p.position - spread.middle;
        std::size_t part = 0;
        for (int axis = 0; axis < 3; ++axis) part = 2 * part + (glm::dot(r, spread.axes[axis]) > 0.0 ? 1 : 0);
        parts[part].push_back(p);
    }
    return parts;
}

}  // namespace

RegistrationTarget::RegistrationTarget(std::span<const contact::SurfacePoint> points)
    : positions_(positions_of(points)), tree_(positions_) {
    if (points.empty()) throw Error("there is no surface to register to");
    for (const contact::SurfacePoint& p : points) normals_.push_back(p.normal);
}

double RegistrationTarget::distance(const Vec3& place) const noexcept {
    const std::size_t n = nearest(place);
    const Vec3 difference = place - positions_[n];
    const double plane = std::abs(glm::dot(difference, normals_[n])), point = glm::length(difference);
    return point < 3e-3 ? plane : point;
}

double median_distance(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                       const Pose& pose) {
    if (moving.empty()) throw Error("there is no surface to measure");
    const std::vector<double> all = distances(moving, fixed, pose);
    return all[all.size() / 2];
}

namespace {

enum class From : std::uint8_t { near, far };

/// `near`: the start may be close already, as it is not when starts are only compared.
Registration registered(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                        const Pose& start, const RegistrationSettings& settings, From where) {
    const std::vector<contact::SurfacePoint> some = thinned(moving, settings.max_points);
    const auto from_scale = [&](double widest, double finest) {
        RegistrationSettings scales = settings;
        scales.widest = widest;
        scales.finest = finest;
        Registration made;
        made.pose = anneal(some, fixed, start, scales);
        judge(made, some, fixed, start, settings.finest);
        return made;
    };
    const Registration far = from_scale(settings.widest, settings.finest);
    if (where == From::far) return far;
    // A displaced part rotates the whole while it is within the kernel's reach: continue from near with a narrow
    // kernel.
    const Registration near = from_scale(0.5 * settings.finest, 0.5 * settings.finest);
    Registration best = near.median < far.median ? near : far;
    if (!settings.by_parts) return best;
    // When a large part is elsewhere, the whole lies between two poses. Each octant alone finds one of them; the pose
    // that covers most of the target wins.
    const double tight = 0.25 * settings.finest;
    double most = lies_on(some, fixed, best.pose, tight);
    const Pose from = best.pose;
    for (const std::vector<contact::SurfacePoint>& part : parts_of(some)) {
        if (part.size() < 50) continue;
        RegistrationSettings scales = settings;
        scales.widest = 4.0 * settings.finest;
        scales.finest = 0.5 * settings.finest;
        scales.stages = 30;
        const Pose alone = anneal(part, fixed, from, scales);
        scales.widest = scales.finest = 0.5 * settings.finest;
        const Pose pose = anneal(some, fixed, alone, scales);
        const double share = lies_on(some, fixed, pose, tight);
        if (!(share > 1.02 * most)) continue;
        most = share;
        best.pose = pose;
        judge(best, some, fixed, start, settings.finest);
    }
    return best;
}

}  // namespace

Registration register_surface(std::span<const contact::SurfacePoint> moving, const RegistrationTarget& fixed,
                              const Pose& start, const RegistrationSettings& settings) {
    if (moving.empty()) throw Error("there is no surface to register");
    return registered(moving, fixed, start, settings, From::near);
}

namespace {

constexpr int start_count = 24;

/// Coarse registrations from all starts.
std::vector<Registration> coarse_registrations(std::span<const contact::SurfacePoint> moving,
                                               std::span<const contact::SurfacePoint> fixed_points,
                                               const RegistrationTarget& fixed, const RegistrationSettings& settings) {
    const Spread from = spread_of(moving), to = spread_of(fixed_points);
    RegistrationSettings coarse = settings;
    coarse.max_points = std::max<std::size_t>(200, settings.max_points / 8);
    coarse.finest = 3.0 * settings.finest;
    coarse.stages = settings.stages / 2;
    coarse.by_parts = false;
    std::vector<Registration> found;
    for (int n = 0; n < start_count; ++n) {
        // Aligns the principal axes in the four proper ways, each also rotated about the longest axis in steps of a
        // sixth.
        Mat3 axes = to.axes;
        if (n & 1) axes[0] = -axes[0], axes[1] = -axes[1];
        const Quat about = glm::angleAxis(2.0 * std::numbers::pi * (n / 2) / 12.0, to.axes[0]);
        const Quat rotation = glm::normalize(about * glm::quat_cast(axes * glm::transpose(from.axes)));
        found.push_back(registered(moving, fixed, {to.middle - rotation * from.middle, rotation}, coarse, From::far));
    }
    return found;
}

/// Compares poses by the distances of both surfaces: those of some points of each from all points of the other. A thinned
/// target would add an error of its own, at edges as large as the difference between rivals.
class PoseScore {
public:
    PoseScore(std::span<const contact::SurfacePoint> moving, std::span<const contact::SurfacePoint> fixed,
              const RegistrationTarget& to_fixed)
        : moving_(thinned(moving, most)),
          fixed_(thinned(fixed, most)),
          to_moving_(moving),
          to_fixed_(to_fixed),
          gyration_(std::min(spread_of(moving).gyration, spread_of(fixed).gyration)),
          middle_(spread_of(moving).middle) {
        const double a = area_of(moving), b = area_of(fixed);
        counts_moving_ = a < 1.25 * b;
        counts_fixed_ = b < 1.25 * a;
    }

    double gyration() const { return gyration_; }
    double limit() const { return distance_limit * gyration_; }

    /// m, root mean square.
    double operator()(const Pose& pose) const {
        double sum = 0.0, area = 0.0;
        if (counts_moving_) add(moving_, to_fixed_, pose, sum, area);
        if (counts_fixed_) add(fixed_, to_moving_, pose.inverse(), sum, area);
        return std::sqrt(sum / area);
    }

    bool is_same(const Pose& a, const Pose& b) const {
        const double cosine = std::min(1.0, std::abs(glm::dot(a.orientation, b.orientation)));
        return 2.0 * std::acos(cosine) < 20.0 * std::numbers::pi / 180.0 &&
               glm::length(a.apply(middle_) - b.apply(middle_)) < 0.25 * gyration_;
    }

private:
    static constexpr std::size_t most = 1500;
    static constexpr double distance_limit = 0.25;

    static double area_of(std::span<const contact::SurfacePoint> points) {
        double area = 0.0;
        for (const contact::SurfacePoint& p : points) area += p.area;
        return area;
    }

    /// Distances count up to a quarter of the size, and so do points whose surfaces look away from each other.
    void add(const std::vector<contact::SurfacePoint>& points, const RegistrationTarget& target, const Pose& pose,
             double& sum, double& area) const {
        const double limit = distance_limit * gyration_;
        for (const contact::SurfacePoint& p : points) {
            const Vec3 at = pose.apply(p.position);
            const std::size_t n = target.nearest(at);
            const Vec3 difference = at - target.position(n);
            // To the plane of the nearest point, where that is near.
            const double plane = std::abs(glm::dot(difference, target.normal(n))), point = glm::length(difference);
            double d = point < limit ? plane : limit;
            if (glm::dot(pose.rotate(p.normal), target.normal(n)) < 0.0) d = limit;
            d = std::min(d, limit);
            sum += p.area * d * d;
            area += p.area;
        }
    }

    std::vector<contact::SurfacePoint> moving_, fixed_;
    RegistrationTarget to_moving_;
    const RegistrationTarget& to_fixed_;
    double gyration_;
    Vec3 middle_;
    bool counts_moving_ = true, counts_fixed_ = true;
};

}  // namespace

Registration register_from_anywhere(std::span<const contact::SurfacePoint> moving,
                                    std::span<const contact::SurfacePoint> fixed_points,
                                    const RegistrationTarget& fixed, const RegistrationSettings& settings) {
    if (moving.empty()) throw Error("there is no surface to register");
    const std::vector<Registration> found = coarse_registrations(moving, fixed_points, fixed, settings);
    const auto best = std::ranges::min_element(found, {}, &Registration::median);
    return register_surface(moving, fixed, best->pose, settings);
}

JudgedRegistration search_registration(std::span<const contact::SurfacePoint> moving,
                                       std::span<const contact::SurfacePoint> fixed_points,
                                       const RegistrationTarget& fixed, const Pose* start,
                                       const RegistrationSettings& settings) {
    if (moving.empty()) throw Error("there is no surface to register");
    constexpr std::size_t refined = 4;  // poses
    constexpr double clearly_better = 0.75, as_good = 0.95;  // of a rival's score
    constexpr double comes_together = 0.6;  // of the limit of a distance
    const PoseScore score(moving, fixed_points, fixed);
    std::vector<JudgedRegistration::Rival> coarse;
    for (const Registration& each : coarse_registrations(moving, fixed_points, fixed, settings))
        coarse.push_back({each.pose, score(each.pose)});
    std::ranges::stable_sort(coarse, {}, &JudgedRegistration::Rival::score);

    std::vector<std::pair<Registration, double>> found;
    const auto add = [&](const Pose& from) {
        Registration made = register_surface(moving, fixed, from, settings);
        const double value = score(made.pose);
        for (auto& [known, known_score] : found)
            if (score.is_same(known.pose, made.pose)) {
                if (value < known_score) known = made, known_score = value;
                return;
            }
        found.emplace_back(std::move(made), value);
    };
    if (start) add(*start);
    std::vector<Pose> starts;
    for (const JudgedRegistration::Rival& each : coarse) {
        if (starts.size() == refined) break;
        if (std::ranges::any_of(starts, [&](const Pose& pose) { return score.is_same(pose, each.pose); })) continue;
        starts.push_back(each.pose);
        add(each.pose);
    }
    // Differences below the sampling of the surfaces.
    const double noise = 1e-3 * score.gyration();
    const auto ratio = [&](double better, double worse) { return (better + noise) / (worse + noise); };
    std::size_t best = 0;
    for (std::size_t n = 1; n < found.size(); ++n) {
        const bool is_from_start = start && best == 0;
        if (ratio(found[n].second, found[best].second) < (is_from_start ? as_good : 1.0)) best = n;
    }
    JudgedRegistration judged;
    judged.best = found[best].first;
    judged.score = found[best].second;
    for (std::size_t n = 0; n < found.size(); ++n)
        if (n != best) judged.rivals.push_back({found[n].first.pose, found[n].second});
    std::ranges::stable_sort(judged.rivals, {}, &JudgedRegistration::Rival::score);
    judged.verdict = judged.score > comes_together * score.limit() ? RegistrationVerdict::none
                     : judged.rivals.empty() || ratio(judged.score, judged.rivals.front().score) < clearly_better
                         ? RegistrationVerdict::fit
                         : RegistrationVerdict::ambiguous;
    if (judged.verdict == RegistrationVerdict::ambiguous)
        std::erase_if(judged.rivals, [&](const JudgedRegistration::Rival& rival) {
            return ratio(judged.score, rival.score) < clearly_better;
        });
    if (start) judged.best.before = median_distance(thinned(moving, settings.max_points), fixed, *start);
    return judged;
}

namespace {

/// The connected patch of marked points (gaps below `gap`) with the greatest area.
std::vector<std::size_t> largest_patch(std::span<const contact::SurfacePoint> points, const std::vector<char>& marked,
                                       double gap) {
    const auto patches = contact::patches_of(points, gap, [&](std::size_t n) { return marked[n] != 0; });
    const auto area_of = [&](const std::vector<std::size_t>& patch) {
        double area = 0.0;
        for (const std::size_t n : patch) area += points[n].area;
        return area;
    };
    if (patches.empty()) return {};
    return *std::ranges::max_element(patches, {}, area_of);
}

}  // namespace

std::vector<std::size_t> displaced_region(std::span<const contact::SurfacePoint> moving, const Pose& pose,
                                          const RegistrationTarget& fixed, double away, double gap, double margin) {
    std::vector<char> is_away(moving.size());
    for (std::size_t n = 0; n < moving.size(); ++n) is_away[n] = fixed.distance(pose.apply(moving[n].position)) > away;
    const auto largest = largest_patch(moving, is_away, gap);
    std::vector<char> taken(moving.size(), 0);
    const contact::Neighbours neighbours(moving, std::max(margin, 1e-9));
    for (const std::size_t n : largest) neighbours.around(n, [&](std::size_t m) { taken[m] = 1; });
    std::vector<std::size_t> region;
    for (std::size_t n = 0; n < taken.size(); ++n)
        if (taken[n]) region.push_back(n);
    return region;
}

std::vector<std::size_t> region_nearer(std::span<const contact::SurfacePoint> moving, const Pose& rest, const Pose& own,
                                       const RegistrationTarget& fixed, double nearer, double away, double gap) {
    std::vector<char> fits_better(moving.size());
    for (std::size_t n = 0; n < moving.size(); ++n) {
        const double there = fixed.distance(own.apply(moving[n].position));
        fits_better[n] = there < away && there + nearer < fixed.distance(rest.apply(moving[n].position));
    }
    return largest_patch(moving, fits_better, gap);
}

}  // namespace tactus::fit
