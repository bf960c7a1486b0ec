// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/jaw_curve.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/closest_point.hpp"
#include "dsp/rope/measure.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::reconstruction {

namespace {

constexpr double spacing = 0.5e-3;
constexpr std::size_t max_points = 1001, max_segments = 5;

/// Sums over the first points, from which the squared distances of any run of points from its chord follow.
struct Moments {
    std::vector<Vec3> sum;
    std::vector<Mat3> square;

    explicit Moments(const std::vector<Vec3>& points) : sum{Vec3(0.0)}, square{Mat3(0.0)} {
        for (const Vec3& p : points) {
            sum.push_back(sum.back() + p);
            square.push_back(square.back() + glm::outerProduct(p, p));
        }
    }

    /// Of the points i to j - 1 from the line through `from` along `u`.
    double off_line(std::size_t i, std::size_t j, const Vec3& from, const Vec3& u) const {
        const double count = static_cast<double>(j - i);
        const Vec3 s = sum[j] - sum[i];
        const Mat3 about = square[j] - square[i] - glm::outerProduct(s, from) - glm::outerProduct(from, s) +
                           count * glm::outerProduct(from, from);
        return std::max(0.0, about[0][0] + about[1][1] + about[2][2] - glm::dot(u, about * u));
    }
};

std::vector<Vec3> candidates(std::span<const Vec3> curve) {
    for (const Vec3& p : curve)
        if (!is_finite(p)) throw Error("a point of the jaw's curve is no point");
    const double count = std::ceil(rope::length_of(curve) / spacing) + 1.0;
    std::vector<Vec3> points =
        rope::resampled(curve, static_cast<std::size_t>(std::clamp(count, 3.0, static_cast<double>(max_points))));
    return points;
}

CurveSplit measured(const std::vector<Vec3>& points, const std::vector<std::size_t>& ends) {
    CurveSplit split;
    double squares = 0.0;
    for (const std::size_t end : ends) split.joints.push_back(points[end]);
    for (std::size_t n = 0; n + 1 < ends.size(); ++n)
        for (std::size_t p = ends[n]; p < ends[n + 1]; ++p) {
            const double off =
                glm::length(points[p] - geometry::closest_on_segment(points[p], points[ends[n]], points[ends[n + 1]]));
            squares += off * off;
            split.greatest = std::max(split.greatest, off);
        }
    split.rms = std::sqrt(squares / static_cast<double>(points.size() - 1));
    return split;
}

}  // namespace

CurveSplit split_at(std::span<const Vec3> curve, std::span<const double> places) {
    const std::vector<Vec3> points = candidates(curve);
    const double step = rope::length_of(curve) / static_cast<double>(points.size() - 1);
    std::vector<std::size_t> ends{0};
    for (const double place : places) {
        const double at = std::round(place / step);
        if (!(at > static_cast<double>(ends.back()) && at < static_cast<double>(points.size() - 1)))
            throw Error("joints must lie on the curve, each after the one before");
        ends.push_back(static_cast<std::size_t>(at));
    }
    ends.push_back(points.size() - 1);
    return measured(points, ends);
}

CurveSplit split_curve(std::span<const Vec3> curve, std::size_t segments, double min_segment) {
    if (segments < 1 || segments > max_segments)
        throw Error(fmt::format("{} segments: a plan has one to {}", segments, max_segments));
    std::vector<Vec3> points = candidates(curve);
    const Vec3 shift = points.front();  // near the origin the sums lose fewer digits
    for (Vec3& p : points) p -= shift;
    const Moments moments(points);
    const std::size_t count = points.size();
    constexpr double none = std::numeric_limits<double>::infinity();
    // least[j]: of all splits of the points up to j into the segments so far.
    std::vector<double> least(count, none);
    std::vector<std::vector<std::size_t>> from(segments, std::vector<std::size_t>(count, 0));
    least[0] = 0.0;
    for (std::size_t segment = 0; segment < segments; ++segment) {
        std::vector<double> next(count, none);
        for (std::size_t j = 1; j < count; ++j)
            for (std::size_t i = 0; i < j; ++i) {
                if (least[i] == none) continue;
                const Vec3 chord = points[j] - points[i];
                const double length = glm::length(chord);
                if (!(length >= min_segment && length > 0.0)) continue;
                const double cost = least[i] + moments.off_line(i, j, points[i], chord / length);
                if (cost < next[j]) next[j] = cost, from[segment][j] = i;
            }
        least = std::move(next);
    }
    if (least.back() == none)
        throw Error(fmt::format("the jaw's curve of {:.1f} mm has no room for {} segments of at least {:.1f} mm",
                                rope::length_of(points) * 1e3, segments, min_segment * 1e3));
    std::vector<std::size_t> ends{count - 1};
    for (std::size_t segment = segments; segment-- > 0;) ends.push_back(from[segment][ends.back()]);
    std::ranges::reverse(ends);
    CurveSplit split = measured(points, ends);
    for (Vec3& joint : split.joints) joint += shift;
    return split;
}

}  // namespace tactus::reconstruction
