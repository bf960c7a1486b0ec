// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruct/fibula_plan.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::reconstruct {

namespace {

constexpr double mm = 1e-3, degree = std::numbers::pi / 180.0;
constexpr double least_segment = 1.0 * mm, greatest_tilt = 75.0 * degree, greatest_mismatch = 1.0 * degree;
constexpr std::size_t most_planes = 6;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

/// Unit length. Throws Error when the vector is nearly 0 or not finite.
Vec3 direction(const Vec3& v, const std::string& what) {
    const double length = glm::length(v);
    if (!(length > 1e-9 && length < 1e9)) throw Error(fmt::format("{} is no direction", what));
    return v / length;
}

std::string nth(std::size_t plane) { return fmt::format("plane {}", plane + 1); }

/// The jaw's side of a plan: planes with normals along the jaw, axes of the segments.
struct JawSide {
    std::vector<Plane> planes;
    std::vector<Vec3> axis, y;
};

JawSide jaw_side(const FibulaInputs& inputs) {
    const std::size_t count = inputs.planes.size();
    if (count < 2 || count > most_planes)
        throw Error(fmt::format("{} planes: a plan needs 2 to {}, for one to {} segments", count, most_planes,
                                most_planes - 1));
    JawSide jaw;
    for (std::size_t n = 0; n + 1 < count; ++n) {
        const Vec3 along = inputs.planes[n + 1].origin - inputs.planes[n].origin;
        if (!is_finite(along) || !(glm::length(along) >= least_segment))
            throw Error(fmt::format("{} and {}: their origins are less than 1 mm apart", nth(n), nth(n + 1)));
        jaw.axis.push_back(glm::normalize(along));
    }
    for (std::size_t n = 0; n < count; ++n) {
        const JawPlane& given = inputs.planes[n];
        const bool is_end = n == 0 || n + 1 == count;
        const Vec3 before = jaw.axis[n == 0 ? 0 : n - 1], after = jaw.axis[std::min(n, jaw.axis.size() - 1)];
        if (!given.normal && is_end) throw Error(fmt::format("{}: a plane at an end needs a normal", nth(n)));
        Vec3 normal = given.normal ? direction(*given.normal, nth(n) + ": the normal")
                                   : direction(before + after, nth(n) + ": the bisecting normal");
        if (glm::dot(normal, before + after) < 0.0) normal = -normal;
        for (const Vec3& axis : {before, after})
            if (angle_between(normal, axis) > greatest_tilt)
                throw Error(fmt::format("{}: it is tilted by {:.1f}° against a segment; at most {:.0f}°", nth(n),
                                        angle_between(normal, axis) / degree, greatest_tilt / degree));
        jaw.planes.push_back({given.origin, normal});
        const Vec3 superior(0.0, 0.0, 1.0);
        const Vec3 y = given.y ? *given.y : superior - glm::dot(superior, normal) * normal;
        jaw.y.push_back(direction(y, nth(n) + ": its y"));
    }
    return jaw;
}

/// Frame with z along `axis` and x = y × z.
Mat3 frame_of(const Vec3& axis, const Vec3& y, const std::string& what) {
    const Vec3 across = glm::cross(y, axis);
    if (glm::length(across) < 1e-3) throw Error(fmt::format("{}: its y is parallel to the segment", what));
    const Vec3 x = glm::normalize(across);
    return {x, glm::cross(axis, x), axis};
}

/// Extent of a section along the line, from line_point.
struct Extent {
    double low = 0.0, high = 0.0;
};

/// The donor's side: its line and surface.
struct Donor {
    const FibulaInputs& inputs;
    Vec3 axis;
    Mat3 frame;
    Extent bone{};  ///< of the whole bone

    explicit Donor(const FibulaInputs& inputs_)
        : inputs(inputs_), axis(direction(inputs_.line_direction, "the line's direction")) {
        const Vec3 posterior = inputs.leg == Leg::left ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, -1.0, 0.0);
        // x = line × posterior; frame_of takes x = y × z.
        frame = frame_of(axis, -posterior, "the line");
        if (!inputs.donor) return;
        bone = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const Vec3& v : inputs.donor->vertices) {
            bone.low = std::min(bone.low, along(v));
            bone.high = std::max(bone.high, along(v));
        }
    }

    double along(const Vec3& p) const { return glm::dot(p - inputs.line_point, axis); }
    Vec3 at(double s) const { return inputs.line_point + s * axis; }

    /// Throws Error when the plane does not meet the bone round the line.
    std::vector<Vec3> section(const Plane& plane, std::size_t segment) const {
        const std::vector<Vec3> points = section_points(*inputs.donor, plane, &plane.origin);
        const double s = along(plane.origin);
        if (points.empty())
            throw Error(
                fmt::format("segment {}: a cut {:.1f} mm along the line misses the donor, which reaches from {:.1f} to "
                            "{:.1f} mm",
                            segment + 1, s / mm, bone.low / mm, bone.high / mm));
        Vec3 centre(0.0);
        for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
        const Vec3 aside = centre - at(along(centre));
        if (glm::length(aside) > inputs.farthest_from_line)
            throw Error(fmt::format(
                "segment {}: {:.1f} mm along the line the donor's centre is {:.1f} mm away from it, more than "
                "{:.1f} mm; the donor must be straight there and the line must follow it",
                segment + 1, s / mm, glm::length(aside) / mm, inputs.farthest_from_line / mm));
        return points;
    }

    Extent extent(const std::vector<Vec3>& points) const {
        Extent out{along(points[0]), along(points[0])};
        for (const Vec3& p : points) {
            out.low = std::min(out.low, along(p));
            out.high = std::max(out.high, along(p));
        }
        return out;
    }
};

/// A segment whose axis meets its first plane `start` along the line.
FibulaSegment segment_at(const JawSide& jaw, const Donor& donor, std::size_t n, double start) {
    const Plane &first = jaw.planes[n], &last = jaw.planes[n + 1];
    FibulaSegment segment;
    segment.length_centre = glm::length(last.origin - first.origin);
    const Mat3 turn = frame_of(jaw.axis[n], jaw.y[n], nth(n)) * glm::transpose(donor.frame);
    const Quat orientation = glm::normalize(glm::quat_cast(turn));
    segment.donor_to_target = {first.origin - orientation * donor.at(start), orientation};
    segment.along_line = {start, start + segment.length_centre};
    const Quat back = glm::conjugate(orientation);
    for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 normal = back * jaw.planes[n + end].normal;
        segment.donor_plane[end] = {donor.at(segment.along_line[end]), normal};
        segment.tilt[end] = angle_between(normal, donor.axis);
    }
    segment.end_angle = angle_between(segment.donor_plane[0].normal, segment.donor_plane[1].normal);
    return segment;
}

/// The start at which the lowest point of the segment's first section lies `low` along the line. The section changes
/// with its place, so the start is found by iteration.
double start_for(const JawSide& jaw, const Donor& donor, std::size_t n, double low) {
    double start = low;
    for (int round = 0; round < 30; ++round) {
        const FibulaSegment trial = segment_at(jaw, donor, n, start);
        const double change = low - donor.extent(donor.section(trial.donor_plane[0], n)).low;
        start += change;
        if (std::abs(change) < 1e-7) break;
    }
    return start;
}

void warn_of(FibulaPlan& plan, const FibulaInputs& inputs) {
    const auto add = [&](PlanWarning code, std::size_t segment, std::string text) {
        plan.warnings.push_back({code, std::move(text), static_cast<int>(segment)});
    };
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const double length = plan.segments[n].length_shortest.value_or(plan.segments[n].length_centre);
        const char* how = plan.segments[n].length_shortest ? "at its shortest" : "at its centre";
        if (length < inputs.very_short_segment)
            add(PlanWarning::very_short_segment, n,
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: it may have no blood supply", n + 1,
                            length / mm, how, inputs.very_short_segment / mm));
        else if (length < inputs.short_segment)
            add(PlanWarning::short_segment, n,
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: its blood supply is in doubt", n + 1,
                            length / mm, how, inputs.short_segment / mm));
    }
    for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
        if (plan.clearances[n] && *plan.clearances[n] < inputs.between - 1e-6)
            add(PlanWarning::close_osteotomies, n,
                fmt::format(
                    "between segments {} and {} there are {:.2f} mm of bone along the line, less than {:.2f} mm", n + 1,
                    n + 2, *plan.clearances[n] / mm, inputs.between / mm));
        const double before = plan.segments[n].tilt[1], after = plan.segments[n + 1].tilt[0];
        if (std::abs(before - after) > greatest_mismatch)
            add(PlanWarning::section_mismatch, n,
                fmt::format(
                    "plane {} is tilted by {:.1f}° against segment {} and by {:.1f}° against segment {}: the two "
                    "sections differ",
                    n + 2, before / degree, n + 1, after / degree, n + 2));
    }
}

}  // namespace

const char* name_of(PlanWarning warning) {
    switch (warning) {
        case PlanWarning::short_segment: return "short-segment";
        case PlanWarning::very_short_segment: return "very-short-segment";
        case PlanWarning::close_osteotomies: return "close-osteotomies";
        case PlanWarning::distal_margin: return "distal-margin";
        case PlanWarning::proximal_margin: return "proximal-margin";
        case PlanWarning::section_mismatch: return "section-mismatch";
    }
    return "";
}

FibulaPlan plan_fibula(const FibulaInputs& inputs) {
    const JawSide jaw = jaw_side(inputs);
    const Donor donor(inputs);
    const std::size_t count = jaw.axis.size();
    if (!inputs.along_line.empty() && inputs.along_line.size() != count)
        throw Error(fmt::format("{} places along the line for {} segments", inputs.along_line.size(), count));
    FibulaPlan plan;
    double free_from = inputs.donor ? donor.bone.low + inputs.distal_margin : 0.0;
    std::optional<Extent> lowest, before;
    for (std::size_t n = 0; n < count; ++n) {
        const double start = !inputs.along_line.empty() ? inputs.along_line[n]
                             : inputs.donor             ? start_for(jaw, donor, n, free_from)
                                                        : free_from;
        plan.segments.push_back(segment_at(jaw, donor, n, start));
        FibulaSegment& segment = plan.segments.back();
        free_from = segment.along_line[1] + inputs.between;
        if (!inputs.donor) {
            if (n > 0) plan.clearances.push_back({});
            continue;
        }
        const std::vector<Vec3> first = donor.section(segment.donor_plane[0], n),
                                last = donor.section(segment.donor_plane[1], n);
        // Both planes are graphs over the cross-section: the length at an outline point is that between them.
        const auto length_at = [&](const Vec3& p) {
            const auto reach = [&](const Plane& plane) {
                return glm::dot(plane.normal, plane.origin - p) / glm::dot(plane.normal, donor.axis);
            };
            return reach(segment.donor_plane[1]) - reach(segment.donor_plane[0]);
        };
        segment.length_shortest = std::numeric_limits<double>::infinity();
        segment.length_longest = -std::numeric_limits<double>::infinity();
        for (const auto& outline : {first, last})
            for (const Vec3& p : outline) {
                segment.length_shortest = std::min(*segment.length_shortest, length_at(p));
                segment.length_longest = std::max(*segment.length_longest, length_at(p));
            }
        if (!(*segment.length_shortest > 0.0))
            throw Error(fmt::format(
                "segment {}: its two planes meet inside the donor; move them apart or tilt them less", n + 1));
        const Extent low = donor.extent(first), high = donor.extent(last);
        if (before) plan.clearances.push_back(low.low - before->high);
        if (!lowest) lowest = low;
        before = high;
        free_from = high.high + inputs.between;
    }
    warn_of(plan, inputs);
    if (lowest) {
        const double distal = lowest->low - donor.bone.low, proximal = donor.bone.high - before->high;
        if (distal < inputs.distal_margin - 1e-6)
            plan.warnings.push_back({PlanWarning::distal_margin,
                                     fmt::format("{:.1f} mm of donor are left at the ankle, less than {:.0f} mm",
                                                 distal / mm, inputs.distal_margin / mm),
                                     0});
        if (proximal < inputs.proximal_margin)
            plan.warnings.push_back(
                {PlanWarning::proximal_margin,
                 fmt::format("{:.1f} mm of donor are left at the knee, less than {:.0f} mm (a placeholder "
                             "without a source)",
                             proximal / mm, inputs.proximal_margin / mm),
                 static_cast<int>(count) - 1});
    }
    for (std::size_t n = 0; n + 1 < count; ++n)
        plan.wedges.push_back(
            angle_between(plan.segments[n].donor_plane[1].normal, plan.segments[n + 1].donor_plane[0].normal));
    return plan;
}

}  // namespace tactus::reconstruct
