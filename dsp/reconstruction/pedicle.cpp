// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/pedicle.hpp"

#include "dsp/rope/measure.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::reconstruction {

namespace {

/// The planes of a segment in donor order: normals run along the line, to the knee.
std::array<Plane, 2> low_and_high(const FibulaSegment& s) {
    const bool is_reversed = s.along_line[0] > s.along_line[1];
    return {s.donor_plane[is_reversed ? 1 : 0], s.donor_plane[is_reversed ? 0 : 1]};
}

double height(const Plane& plane, const Vec3& p) { return glm::dot(plane.normal, p - plane.origin); }

/// Pieces of a line, none of which crosses a cut, with the segment on which each lies.
struct Run {
    std::size_t segment;
    std::vector<Vec3> points;
};

std::vector<Run> runs_of(const std::vector<Vec3>& line, const FibulaPlan& plan) {
    std::vector<Run> runs;
    std::vector<double> at;
    for (std::size_t n = 0; n + 1 < line.size(); ++n) {
        at = {0.0, 1.0};
        for (const FibulaSegment& s : plan.segments)
            for (const Plane& plane : s.donor_plane) {
                const double a = height(plane, line[n]), b = height(plane, line[n + 1]);
                if ((a < 0.0) != (b < 0.0)) at.push_back(a / (a - b));
            }
        std::ranges::sort(at);
        for (std::size_t k = 0; k + 1 < at.size(); ++k) {
            const Vec3 from = glm::mix(line[n], line[n + 1], at[k]), to = glm::mix(line[n], line[n + 1], at[k + 1]);
            if (from == to) continue;
            const std::size_t on = segment_at(plan, 0.5 * (from + to));
            if (runs.empty() || runs.back().segment != on) runs.push_back({on, {from}});
            runs.back().points.push_back(to);
        }
    }
    return runs;
}

}  // namespace

std::size_t segment_at(const FibulaPlan& plan, const Vec3& at) {
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const auto [low, high] = low_and_high(plan.segments[n]);
        if (height(low, at) >= 0.0 && height(high, at) <= 0.0) return n;
    }
    return plan.segments.size();
}

double distance_to_cuts(const FibulaPlan& plan, const Vec3& at) {
    double least = std::numeric_limits<double>::infinity();
    for (const FibulaSegment& s : plan.segments)
        for (const Plane& plane : s.donor_plane) least = std::min(least, std::abs(height(plane, at)));
    return least;
}

std::vector<VesselPart> parts_of(const FlapVessel& vessel, const FibulaInputs& inputs, const FibulaPlan& plan) {
    std::vector<Vec3> line = vessel.points;
    if (glm::dot(line.back() - line.front(), inputs.line_direction) > 0.0) std::ranges::reverse(line);
    const std::vector<Run> runs = runs_of(line, plan);
    const std::size_t none = plan.segments.size();
    std::size_t last = runs.size();  // the last run that lies on a segment
    for (std::size_t n = 0; n < runs.size(); ++n)
        if (runs[n].segment != none) last = n;
    std::vector<VesselPart> parts;
    for (std::size_t n = 0; n < runs.size(); ++n) {
        using enum VesselPart::Kind;
        VesselPart part;
        const bool is_first = parts.empty();
        part.kind = runs[n].segment != none           ? attached
                    : last == runs.size() || n > last ? lost
                    : is_first                        ? pedicle
                                                      : span;
        part.segment = part.kind == attached  ? runs[n].segment
                       : part.kind == pedicle ? runs[n + 1].segment
                       : part.kind == span    ? runs[n - 1].segment
                                              : 0;
        part.points = runs[n].points;
        part.length = rope::length_of(part.points);
        parts.push_back(std::move(part));
    }
    return parts;
}

PlacedVessel placed(const FlapVessel& vessel, const std::vector<VesselPart>& parts, const FibulaPlan& plan) {
    using enum VesselPart::Kind;
    PlacedVessel made{vessel.name, vessel.kind, vessel.radius, {}};
    std::vector<Vec3> line;
    for (const VesselPart& part : parts) {
        if (part.kind != attached) continue;
        std::vector<Vec3> there;
        for (const Vec3& p : part.points) there.push_back(plan.segments[part.segment].donor_to_target.apply(p));
        line.insert(line.end(), there.begin(), there.end());  // what lies between is the span
    }
    if (line.size() > 1) made.lines.push_back(std::move(line));
    return made;
}

}  // namespace tactus::reconstruction
