// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/target_deviation.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::reconstruction {

namespace {

constexpr double max_target_distance = 15.0 * mm;  // farther away the target is another part of the jaw
constexpr double max_section_step = 2.0 * mm;

std::vector<contact::SurfacePoint> vertices_of(const geometry::TriangleSurface& surface) {
    std::vector<contact::SurfacePoint> points(surface.vertices.size());
    for (std::size_t n = 0; n < points.size(); ++n) points[n] = {surface.vertices[n], Vec3(0.0), 0.0, 0};
    for (const auto& t : surface.triangles) {
        const auto corner = [&](std::size_t c) { return static_cast<std::size_t>(t[c]); };
        const Vec3 across = glm::cross(surface.vertices[corner(1)] - surface.vertices[corner(0)],
                                       surface.vertices[corner(2)] - surface.vertices[corner(0)]);
        for (std::size_t c = 0; c < 3; ++c) points[corner(c)].normal += across;
    }
    std::erase_if(points, [](const contact::SurfacePoint& p) { return !(glm::length(p.normal) > 0.0); });
    if (points.empty()) throw Error("the target has no surface");
    for (contact::SurfacePoint& p : points) p.normal = glm::normalize(p.normal);
    return points;
}

/// Of the outlines within reach: below a ramus, the middle of a whole section lies far above the body of the jaw.
std::optional<Vec3> middle_near(const Vec3& at, const Section& section) {
    Vec3 sum(0.0);
    double all = 0.0;
    for (const auto& [from, to] : section.pieces) {
        const Vec3 &a = section.points[from], &b = section.points[to], middle = 0.5 * (a + b);
        if (glm::length(middle - at) > max_target_distance) continue;
        sum += glm::length(b - a) * middle;
        all += glm::length(b - a);
    }
    return all > 0.0 ? std::optional(sum / all) : std::nullopt;
}

std::optional<SegmentDeviation::Curve> curve_deviation(const Vec3& from, const Vec3& to,
                                                       const geometry::TriangleSurface& target) {
    const Vec3 along = to - from;
    const int steps = std::max(2, static_cast<int>(std::ceil(glm::length(along) / max_section_step)));
    SegmentDeviation::Curve curve;
    int count = 0;
    for (int n = 0; n < steps; ++n) {
        const Vec3 at = from + (n + 0.5) / steps * along;
        const std::optional<Vec3> middle = middle_near(at, section_of(target, {at, glm::normalize(along)}, &at));
        if (!middle) continue;
        const double away = glm::length(*middle - at);
        curve.rms += away * away;
        curve.greatest = std::max(curve.greatest, away);
        ++count;
    }
    if (2 * count < steps) return std::nullopt;
    curve.rms = std::sqrt(curve.rms / count);
    return curve;
}

/// Triangles of the donor's outer surface between the two cuts of a segment.
std::optional<SegmentDeviation::Contour> contour_deviation(const geometry::TriangleSurface& donor,
                                                           const FibulaSegment& segment,
                                                           const fit::RegistrationTarget& target) {
    const auto& [first, last] = segment.donor_plane;
    const Vec3 axis = glm::normalize(last.origin - first.origin);
    std::vector<std::pair<double, double>> distances;  // m, and m²
    double all = 0.0, facing = 0.0, squares = 0.0;
    for (const auto& t : donor.triangles) {
        const Vec3 &a = donor.vertices[static_cast<std::size_t>(t[0])],
                   &b = donor.vertices[static_cast<std::size_t>(t[1])],
                   &c = donor.vertices[static_cast<std::size_t>(t[2])];
        const Vec3 middle = (a + b + c) / 3.0, across = glm::cross(b - a, c - a);
        // The normals of both cuts point along the line.
        const double before = glm::dot(middle - first.origin, first.normal),
                     after = glm::dot(middle - last.origin, last.normal);
        if (before * after >= 0.0 || !(glm::length(across) > 0.0)) continue;
        const Vec3 out = (middle - first.origin) - glm::dot(middle - first.origin, axis) * axis;
        if (glm::dot(out, across) <= 0.0) continue;  // the marrow cavity
        const double area = 0.5 * glm::length(across);
        all += area;
        const Vec3 at = segment.donor_to_target.apply(middle),
                   normal = segment.donor_to_target.rotate(glm::normalize(across));
        const std::size_t nearest = target.nearest(at);
        const Vec3 away = at - target.position(nearest);
        if (glm::length(away) > max_target_distance || glm::dot(normal, target.normal(nearest)) < 0.5) continue;
        const double beyond = glm::dot(away, target.normal(nearest));
        distances.emplace_back(beyond, area);
        facing += area;
        squares += area * beyond * beyond;
    }
    if (distances.empty()) return std::nullopt;
    std::ranges::sort(distances);
    const auto at_share = [&](double share) {
        double sum = 0.0;
        for (const auto& [beyond, area] : distances)
            if ((sum += area) >= share * facing) return beyond;
        return distances.back().first;
    };
    return SegmentDeviation::Contour{std::sqrt(squares / facing), at_share(0.025), at_share(0.975), facing / all};
}

}  // namespace

DeviationTarget::DeviationTarget(geometry::TriangleSurface from)
    : surface(std::move(from)), points(vertices_of(surface)) {}

std::vector<SegmentDeviation> deviation_of(const FibulaInputs& inputs, const FibulaPlan& plan,
                                           const DeviationTarget& target) {
    if (!inputs.donor) throw Error("a deviation needs the donor's surface");
    const geometry::TriangleSurface donor =
        parts_near_line(*inputs.donor, inputs.line_point, inputs.line_direction, inputs.farthest_from_line);
    std::vector<SegmentDeviation> all;
    for (const FibulaSegment& segment : plan.segments) {
        const auto ends = [&](std::size_t end) {
            return segment.donor_to_target.apply(segment.donor_plane[end].origin);
        };
        all.push_back(
            {curve_deviation(ends(0), ends(1), target.surface), contour_deviation(donor, segment, target.points)});
    }
    return all;
}

}  // namespace tactus::reconstruction
