// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_precision.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::fit {

namespace {

constexpr double correlated = 3e-3;  // m
constexpr double max_off = 0.4e-3;  // m: what is farther off the other face is chipped
constexpr double min_against = 0.7;  // cosine of opposed normals
constexpr std::size_t max_points = 500;  // of a face: the pairs are counted

// Of the calibrated precision.
constexpr double intact_correlated = 2e-3;  // m
constexpr double intact_deviations = 3.0;  // from the median distance: what is farther off is chipped
constexpr std::size_t min_intact_points = 12;
constexpr double widening = 1.1;
constexpr double bias_in_voxels = 0.12;  // of smoothed surfaces

using Slope = std::array<double, 6>;

struct Point {
    Vec3 place;
    double off, share;
    Slope slope;
};

double median_of(std::span<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Adds the information of points whose distances have the correlation length `length`, m. Changes the points.
void add_information(std::span<double, 36> information, std::span<Point> points, double length) {
    double all = 0.0, mean = 0.0, squares = 0.0, pairs = 0.0;
    double slopes[36] = {};
    for (const Point& p : points) {
        all += p.share;
        mean += p.share * p.off;
        for (std::size_t a = 0; a < 6; ++a)
            for (std::size_t b = 0; b < 6; ++b) slopes[6 * a + b] += p.share * p.slope[a] * p.slope[b];
    }
    mean /= all;
    for (Point& p : points) {
        p.off -= mean;
        p.share /= all;
        squares += p.share * p.share * p.off * p.off;
    }
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 apart = points[i].place - points[j].place;
            const double distance2 = glm::dot(apart, apart);
            if (distance2 < length * length)
                pairs += points[i].share * points[j].share * points[i].off * points[j].off *
                         (1.0 - std::sqrt(distance2) / length);
        }
    // At least that of independent points; no scan is exact to a hundredth of a micrometre.
    const double variance = std::max({squares + 2.0 * pairs, squares, 1e-16});
    for (std::size_t n = 0; n < 36; ++n) information[n] += slopes[n] / (all * variance);
}

/// Moves the points that are not chipped to the front and returns their number.
std::size_t intact_first(std::span<Point> points) {
    std::array<double, max_points> values;
    const std::span<double> off(values.data(), points.size());
    std::ranges::transform(points, off.begin(), &Point::off);
    const double middle = median_of(off);
    std::ranges::transform(points, off.begin(), [middle](const Point& p) { return std::abs(p.off - middle); });
    const double limit = intact_deviations * 1.4826 * median_of(off);
    const auto rest = std::ranges::partition(points, [&](const Point& p) { return std::abs(p.off - middle) <= limit; });
    const std::size_t count = points.size() - rest.size();
    return count < min_intact_points ? points.size() : count;
}

}  // namespace

void FitPrecisionSum::add(const FitSurface& moving, const FitSurface& fixed, const Pose& there,
                          const Pose& into) noexcept {
    const Mat3 rotation = glm::mat3_cast(into.orientation);
    std::array<Point, max_points> points;
    const std::size_t stride = moving.position.size() / max_points + 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < moving.position.size(); i += stride) {
        const Vec3 place = into.position + rotation * moving.position[i];
        const volume::Sample here = fixed.field.sample(place);
        if (!here.inside || std::abs(here.value) > max_off || !fixed.is_painted_near(place)) continue;
        if (!(-glm::dot(rotation * moving.normal[i], here.gradient) > min_against)) continue;
        const Vec3 n = there.rotate(here.gradient), turn = glm::cross(there.apply(place) - origin_, n) / lever;
        points[count++] = {place, here.value, moving.share[i], {n.x, n.y, n.z, turn.x, turn.y, turn.z}};
    }
    if (count == 0) return;
    for (const FitSurface* face : {&moving, &fixed}) {
        const Vec3& voxel = face->field.grid.spacing;
        voxel_ = std::max({voxel_, voxel.x, voxel.y, voxel.z});
    }
    std::array<Point, max_points> intact;
    std::copy_n(points.begin(), count, intact.begin());
    const std::size_t intact_count = intact_first({intact.data(), count});
    add_information(information_, {points.data(), count}, correlated);
    add_information(intact_information_, {intact.data(), intact_count}, intact_correlated);
}

FitPrecision FitPrecisionSum::precision() const noexcept { return precision_of(information_); }

FitPrecision FitPrecisionSum::calibrated() const noexcept {
    const FitPrecision all = precision(), intact = precision_of(intact_information_);
    const auto between = [](double a, double b) { return widening * std::sqrt(std::max(a, b) * b); };
    const double bias = bias_in_voxels * voxel_;
    return {between(all.turn, intact.turn), std::hypot(between(all.far, intact.far), bias),
            std::hypot(between(all.face, intact.face), bias)};
}

FitPrecision FitPrecisionSum::precision_of(std::span<const double, 36> matrix) const noexcept {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    std::array<double, 36> information;
    std::ranges::copy(matrix, information.begin());
    const geometry::SymmetricEigen<6> eigen = geometry::symmetric_eigen<6>(information);
    const Vec3 arm = far_ - origin_;
    double turn = 0.0, far = 0.0, face = 0.0;
    for (std::size_t n = 0; n < 6; ++n) {
        if (!(eigen.value[n] > 1e-9 * eigen.value[5])) return {infinite, infinite, infinite};
        const Slope& v = eigen.vector[n];
        const Vec3 rotation = Vec3(v[3], v[4], v[5]) / lever;
        const Vec3 motion = Vec3(v[0], v[1], v[2]) + glm::cross(rotation, arm);
        turn += glm::dot(rotation, rotation) / eigen.value[n];
        far += glm::dot(motion, motion) / eigen.value[n];
        face += (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / eigen.value[n];
    }
    return {2.0 * std::sqrt(turn), 2.0 * std::sqrt(far), 2.0 * std::sqrt(face)};
}

PoseBound bound_of(const FitPrecision& precision, double margin, const Pose& best, const Pose& rival, const Vec3& face,
                   const Vec3& far, bool has_healthy) noexcept {
    constexpr double counted_margin = 0.3;  // a rival whose score is farther below is none
    constexpr double asymmetry = 1.5e-3,
                     asymmetry_turn = std::numbers::pi / 180.0;  // of two sides of a body, m and rad
    PoseBound bound{precision.turn, precision.face, precision.far, margin < counted_margin};
    if (bound.has_rival) {
        bound.turn = std::max(bound.turn, glm::length(rotation_between(best.orientation, rival.orientation)));
        bound.face = std::max(bound.face, glm::length(best.apply(face) - rival.apply(face)));
        bound.far = std::max(bound.far, glm::length(best.apply(far) - rival.apply(far)));
    }
    if (has_healthy) {
        bound.turn = std::max(bound.turn, asymmetry_turn);
        bound.face = std::max(bound.face, asymmetry);
        bound.far = std::max(bound.far, asymmetry + asymmetry_turn * glm::length(far - face));
    }
    return bound;
}

}  // namespace tactus::fit
