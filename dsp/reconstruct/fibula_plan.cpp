// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruct/fibula_plan.hpp"

#include "dsp/core/error.hpp"
#include "dsp/reconstruct/slabs.hpp"

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
constexpr double least_segment = 1.0 * mm, greatest_tilt = 75.0 * degree, greatest_off_bisector = 1.0 * degree;
constexpr double least_y = 0.05;  // sine of the angle below which a direction does not tell a turn about an axis
constexpr std::size_t most_planes = 6;

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

/// Unit length. Throws Error when the vector is nearly 0 or not finite.
Vec3 direction(const Vec3& v, const std::string& what) {
    const double length = glm::length(v);
    if (!(length > 1e-9 && length < 1e9)) throw Error(fmt::format("{} is no direction", what));
    return v / length;
}

std::string nth(std::size_t plane) { return fmt::format("plane {}", plane + 1); }

/// Frame with z along `axis` and x = y × z.
Mat3 frame_of(const Vec3& axis, const Vec3& y) {
    const Vec3 x = glm::normalize(glm::cross(y, axis));
    return {x, glm::cross(axis, x), axis};
}

/// The jaw's side of a plan, in the order in which segments lie in the donor from the ankle on.
struct JawSide {
    std::vector<Plane> planes;  ///< normals along the axes
    std::vector<Vec3> axis, y;  ///< of the segments
    std::vector<double> off_bisector;  ///< rad, of the inner planes
};

Vec3 y_of(const JawPlane& given, const Vec3& normal, const Vec3& axis, std::size_t n) {
    const Vec3 superior(0.0, 0.0, 1.0);
    const Vec3 level = superior - glm::dot(superior, normal) * normal;
    if (!given.y && glm::length(level) < least_y)
        throw Error(fmt::format("{} is nearly horizontal: give it a y, which tells how its segment is turned", nth(n)));
    const Vec3 y = direction(given.y ? *given.y : level, nth(n) + ": its y");
    if (glm::length(glm::cross(y, axis)) < least_y)
        throw Error(fmt::format("{}: {} is parallel to the segment after it: give it {}", nth(n),
                                given.y ? "its y" : "superior", given.y ? "another y" : "a y"));
    return y;
}

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
        const Vec3 bisector = direction(before + after, nth(n) + ": the bisecting normal");
        Vec3 normal = given.normal ? direction(*given.normal, nth(n) + ": the normal") : bisector;
        if (glm::dot(normal, bisector) < 0.0) normal = -normal;
        for (const Vec3& axis : {before, after})
            if (angle_between(normal, axis) > greatest_tilt)
                throw Error(fmt::format("{}: it is tilted by {:.1f}° against a segment; at most {:.0f}°", nth(n),
                                        angle_between(normal, axis) / degree, greatest_tilt / degree));
        jaw.planes.push_back({given.origin, normal});
        if (n + 1 < count) jaw.y.push_back(y_of(given, normal, after, n));
        if (!is_end) jaw.off_bisector.push_back(angle_between(normal, bisector));
    }
    if (inputs.reversed) {
        std::ranges::reverse(jaw.planes);
        std::ranges::reverse(jaw.axis);
        std::ranges::reverse(jaw.y);
        for (Plane& plane : jaw.planes) plane.normal = -plane.normal;
        for (Vec3& axis : jaw.axis) axis = -axis;
    }
    return jaw;
}

/// Extent along the line, from line_point.
struct Extent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

    void add(double s) { low = std::min(low, s), high = std::max(high, s); }
};

/// The donor's side: its line and surface.
struct Donor {
    const FibulaInputs& inputs;
    Vec3 axis;
    Mat3 frame{1.0};
    std::optional<geometry::TriangleSurface> bone;  ///< the parts of the donor's surface that the line follows
    std::optional<Slabs> slabs;  ///< of the bone
    Extent whole{};

    explicit Donor(const FibulaInputs& inputs_)
        : inputs(inputs_), axis(direction(inputs_.line_direction, "the line's direction")) {
        if (!is_finite(inputs.line_point)) throw Error("the line's point is no point");
        // x = y × z must be medial.
        const Vec3 y = inputs.leg == Leg::left ? Vec3(0.0, -1.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        if (glm::length(glm::cross(y, axis)) < least_y)
            throw Error("the line runs from front to back: that does not tell the medial side of the donor");
        frame = frame_of(axis, y);
        if (!inputs.donor) return;
        bone = parts_near_line(*inputs.donor, inputs.line_point, axis, inputs.farthest_from_line);
        for (const Vec3& v : bone->vertices) whole.add(along(v));
        slabs.emplace(*bone, inputs.line_point, axis);
    }
    Donor(const Donor&) = delete;
    Donor& operator=(const Donor&) = delete;

    double along(const Vec3& p) const { return glm::dot(p - inputs.line_point, axis); }
    Vec3 at(double s) const { return inputs.line_point + s * axis; }

    /// Throws Error when the plane does not meet the bone round the line.
    Section section(const Plane& plane, std::size_t segment) const {
        Section found = slabs->section(plane, &plane.origin);
        const double s = along(plane.origin);
        if (found.points.empty())
            throw Error(
                fmt::format("segment {}: a cut {:.1f} mm along the line misses the donor, which reaches from {:.1f} to "
                            "{:.1f} mm",
                            segment + 1, s / mm, whole.low / mm, whole.high / mm));
        const Vec3 aside = found.centre - at(along(found.centre));
        if (glm::length(aside) > inputs.farthest_from_line)
            throw Error(fmt::format(
                "segment {}: {:.1f} mm along the line the donor's centre is {:.1f} mm away from it, more than "
                "{:.1f} mm; the donor must be straight there and the line must follow it",
                segment + 1, s / mm, glm::length(aside) / mm, inputs.farthest_from_line / mm));
        return found;
    }

    Extent extent(const Section& section) const {
        Extent out;
        for (const Vec3& p : section.points) out.add(along(p));
        return out;
    }
};

/// A segment whose axis meets its more distal plane `start` along the line.
FibulaSegment segment_at(const JawSide& jaw, const Donor& donor, std::size_t n, double start) {
    const Plane &first = jaw.planes[n], &last = jaw.planes[n + 1];
    FibulaSegment segment;
    segment.length_centre = glm::length(last.origin - first.origin);
    const Mat3 turn = frame_of(jaw.axis[n], jaw.y[n]) * glm::transpose(donor.frame);
    const Vec3 jaw_axis = donor.inputs.reversed ? -jaw.axis[n] : jaw.axis[n];
    const Quat orientation =
        glm::normalize(glm::angleAxis(donor.inputs.roll, jaw_axis) * glm::normalize(glm::quat_cast(turn)));
    segment.donor_to_target = {first.origin - orientation * donor.at(start), orientation};
    segment.along_line = {start, start + segment.length_centre};
    const Quat back = glm::conjugate(orientation);
    for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 normal = back * jaw.planes[n + end].normal;
        segment.donor_plane[end] = {donor.at(segment.along_line[end]), normal};
        segment.tilt[end] = angle_between(normal, donor.axis);
        const Vec3 medial = donor.frame[0], anterior = donor.inputs.leg == Leg::left ? donor.frame[1] : -donor.frame[1];
        segment.lean_medial[end] = std::atan2(glm::dot(normal, medial), glm::dot(normal, donor.axis));
        segment.lean_anterior[end] = std::atan2(glm::dot(normal, anterior), glm::dot(normal, donor.axis));
    }
    segment.end_angle = angle_between(segment.donor_plane[0].normal, segment.donor_plane[1].normal);
    return segment;
}

/// The start at which the lowest point of the segment's first section lies `low` along the line. The section changes
/// with its place, so the start is found by iteration.
double start_for(const JawSide& jaw, const Donor& donor, std::size_t n, double low) {
    double start = low;
    for (int round = 0; round < 30; ++round) {
        const Plane plane = segment_at(jaw, donor, n, start).donor_plane[0];
        const Section section = donor.slabs->section(plane, &plane.origin);
        // Just below the bone's end there is no section yet.
        const double change = section.points.empty() ? 1.0 * mm : low - donor.extent(section).low;
        start += change;
        if (std::abs(change) < 1e-7) break;
    }
    return start;
}

/// Lengths between the outlines of the segment's two sections. Both planes are graphs over the cross-section: the
/// length at an outline point is that between them.
void measure_lengths(FibulaSegment& segment, const Donor& donor, const std::array<Section, 2>& sections) {
    Extent lengths;
    const auto reach = [&](const Plane& plane, const Vec3& p) {
        return glm::dot(plane.normal, plane.origin - p) / glm::dot(plane.normal, donor.axis);
    };
    for (const Section& section : sections)
        for (const Vec3& p : section.points)
            lengths.add(reach(segment.donor_plane[1], p) - reach(segment.donor_plane[0], p));
    segment.length_shortest = lengths.low;
    segment.length_longest = lengths.high;
}

using Cuts = std::vector<std::array<Section, 2>>;  // per segment

/// From donor order to the order of the jaw's planes.
void to_jaw_order(FibulaPlan& plan, Cuts& cuts) {
    std::ranges::reverse(plan.segments);
    std::ranges::reverse(plan.clearances);
    std::ranges::reverse(cuts);
    for (auto& pair : cuts) std::swap(pair[0], pair[1]);
    for (FibulaSegment& segment : plan.segments) {
        std::swap(segment.tilt[0], segment.tilt[1]);
        std::swap(segment.along_line[0], segment.along_line[1]);
        std::swap(segment.donor_plane[0], segment.donor_plane[1]);
        std::swap(segment.lean_medial[0], segment.lean_medial[1]);
        std::swap(segment.lean_anterior[0], segment.lean_anterior[1]);
    }
}

Section mapped(Section section, const Pose& pose) {
    for (Vec3& p : section.points) p = pose.apply(p);
    return section;
}

void measure_faces(FibulaPlan& plan, const FibulaInputs& inputs, const Cuts& cuts) {
    plan.contact.resize(plan.segments.size() - 1);
    if (cuts.empty()) return;
    plan.kerf_loss = 0.0;
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        FibulaSegment& s = plan.segments[n];
        for (std::size_t end = 0; end < 2; ++end) {
            s.area[end] = overlap_area(cuts[n][end], cuts[n][end], s.donor_plane[end]);
            *plan.kerf_loss += *s.area[end] * inputs.kerf;
            double farthest = 0.0;
            for (const Vec3& p : cuts[n][end].points)
                farthest = std::max(farthest, glm::length(p - s.donor_plane[end].origin));
            s.farthest[end] = farthest;
        }
        if (n + 1 == plan.segments.size()) continue;
        const FibulaSegment& after = plan.segments[n + 1];
        const Plane joint{s.donor_to_target.apply(s.donor_plane[1].origin),
                          s.donor_to_target.rotate(s.donor_plane[1].normal)};
        plan.contact[n] =
            overlap_area(mapped(cuts[n][1], s.donor_to_target), mapped(cuts[n + 1][0], after.donor_to_target), joint);
    }
}

void measure_joints(FibulaPlan& plan, const JawSide& jaw, const Donor& donor) {
    plan.off_bisector = jaw.off_bisector;
    for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
        const FibulaSegment &before = plan.segments[n], &after = plan.segments[n + 1];
        plan.wedges.push_back(angle_between(before.donor_plane[1].normal, after.donor_plane[0].normal));
        // What remains of the turn from one segment to the next when their axes are brought together by the least turn.
        const Vec3 from = before.donor_to_target.rotate(donor.axis), to = after.donor_to_target.rotate(donor.axis);
        const Vec3 side = glm::cross(from, to);
        const double angle = angle_between(from, to);
        const Vec3 carried = before.donor_to_target.rotate(donor.frame[0]);
        const Vec3 brought = glm::length(side) > 1e-9 ? glm::angleAxis(angle, glm::normalize(side)) * carried : carried;
        plan.rolls.push_back(angle_between(brought, after.donor_to_target.rotate(donor.frame[0])));
    }
}

void warn_of(FibulaPlan& plan, const FibulaInputs& inputs, const Donor& donor) {
    const auto add = [&](PlanWarning code, int segment, std::string text) {
        plan.warnings.push_back({code, std::move(text), segment});
    };
    if (donor.axis.z < 0.0)
        add(PlanWarning::line_downwards, -1,
            "the line runs downwards (LPS): it must run from the ankle to the knee, else the margins and the medial "
            "side are exchanged");
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const double length = plan.segments[n].length_shortest.value_or(plan.segments[n].length_centre);
        const char* how = plan.segments[n].length_shortest ? "at its shortest" : "at its centre";
        if (length < inputs.very_short_segment)
            add(PlanWarning::very_short_segment, static_cast<int>(n),
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: it may have no blood supply", n + 1,
                            length / mm, how, inputs.very_short_segment / mm));
        else if (length < inputs.short_segment)
            add(PlanWarning::short_segment, static_cast<int>(n),
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: its blood supply is in doubt", n + 1,
                            length / mm, how, inputs.short_segment / mm));
    }
    for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
        if (plan.clearances[n] && *plan.clearances[n] < 0.0)
            add(PlanWarning::close_osteotomies, static_cast<int>(n),
                fmt::format("segments {} and {} overlap by {:.2f} mm along the line", n + 1, n + 2,
                            -*plan.clearances[n] / mm));
        else if (plan.clearances[n] && *plan.clearances[n] < inputs.between - 1e-6)
            add(PlanWarning::close_osteotomies, static_cast<int>(n),
                fmt::format(
                    "between segments {} and {} there are {:.2f} mm of bone along the line, less than {:.2f} mm", n + 1,
                    n + 2, *plan.clearances[n] / mm, inputs.between / mm));
        if (plan.off_bisector[n] > greatest_off_bisector)
            add(PlanWarning::section_mismatch, static_cast<int>(n),
                fmt::format("plane {} is {:.1f}° from bisecting the angle between segments {} and {}: their two "
                            "sections differ",
                            n + 2, plan.off_bisector[n] / degree, n + 1, n + 2));
    }
    const int last = static_cast<int>(plan.segments.size()) - 1;
    if (plan.left_distal && *plan.left_distal < inputs.distal_margin - 1e-6)
        add(PlanWarning::distal_margin, inputs.reversed ? last : 0,
            fmt::format("{:.1f} mm of donor are left at the ankle, less than {:.0f} mm", *plan.left_distal / mm,
                        inputs.distal_margin / mm));
    if (plan.left_proximal && *plan.left_proximal < inputs.proximal_margin - 1e-6)
        add(PlanWarning::proximal_margin, inputs.reversed ? 0 : last,
            fmt::format("{:.1f} mm of donor are left at the knee, less than {:.0f} mm (a placeholder without a source)",
                        *plan.left_proximal / mm, inputs.proximal_margin / mm));
}

/// Places in donor order, checked.
std::vector<double> places_of(const FibulaInputs& inputs, std::size_t count) {
    std::vector<double> places = inputs.along_line;
    if (places.empty()) return places;
    if (places.size() != count)
        throw Error(fmt::format("{} places along the line for {} segments", places.size(), count));
    if (inputs.reversed) std::ranges::reverse(places);
    for (std::size_t n = 0; n < count; ++n)
        if (!std::isfinite(places[n]) || (n > 0 && !(places[n] > places[n - 1])))
            throw Error(fmt::format("the places along the line must {} from segment to segment",
                                    inputs.reversed ? "decrease" : "increase"));
    return places;
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
        case PlanWarning::line_downwards: return "line-downwards";
    }
    return "";
}

const char* name_of(Resection resection) {
    switch (resection) {
        case Resection::between: return "between";
        case Resection::after_first: return "after-first";
        case Resection::before_last: return "before-last";
        case Resection::none: return "none";
    }
    return "";
}

std::vector<JawPlane> planes_on(const CurveSplit& split) {
    std::vector<JawPlane> planes;
    for (const Vec3& joint : split.joints) planes.push_back({joint, {}, {}});
    if (planes.size() < 2) return planes;
    planes.front().normal = split.joints[1] - split.joints[0];
    planes.back().normal = split.joints.back() - split.joints[split.joints.size() - 2];
    return planes;
}

FibulaPlan plan_fibula(const FibulaInputs& inputs) {
    const JawSide jaw = jaw_side(inputs);
    const Donor donor(inputs);
    const std::size_t count = jaw.axis.size();
    if (!(inputs.kerf >= 0.0 && inputs.kerf < 0.01)) throw Error("the kerf must be 0 to 10 mm");
    if (!std::isfinite(inputs.roll)) throw Error("the roll of the donor is no angle");
    const std::vector<double> places = places_of(inputs, count);
    const auto jaw_number = [&](std::size_t n) { return inputs.reversed ? count - 1 - n : n; };
    FibulaPlan plan;
    double free_from = donor.bone ? donor.whole.low + inputs.distal_margin : 0.0;
    Extent used;
    Cuts cuts;
    for (std::size_t n = 0; n < count; ++n) {
        const double start = !places.empty() ? places[n] : donor.bone ? start_for(jaw, donor, n, free_from) : free_from;
        plan.segments.push_back(segment_at(jaw, donor, n, start));
        FibulaSegment& segment = plan.segments.back();
        free_from = segment.along_line[1] + inputs.between;
        if (!donor.bone) {
            if (n > 0) plan.clearances.push_back({});
            continue;
        }
        cuts.push_back({donor.section(segment.donor_plane[0], jaw_number(n)),
                        donor.section(segment.donor_plane[1], jaw_number(n))});
        const std::array<Section, 2>& sections = cuts.back();
        measure_lengths(segment, donor, sections);
        if (!(*segment.length_shortest > 0.0))
            throw Error(
                fmt::format("segment {}: its two planes meet inside the donor; move them apart or tilt them "
                            "less",
                            jaw_number(n) + 1));
        const Extent low = donor.extent(sections[0]), high = donor.extent(sections[1]);
        if (n > 0) plan.clearances.push_back(low.low - used.high);
        used.add(low.low);
        used.add(high.high);
        free_from = used.high + inputs.between;
    }
    if (donor.bone) {
        plan.left_distal = used.low - donor.whole.low;
        plan.left_proximal = donor.whole.high - used.high;
    }
    if (inputs.reversed) to_jaw_order(plan, cuts);
    measure_faces(plan, inputs, cuts);
    measure_joints(plan, jaw, donor);
    warn_of(plan, inputs, donor);
    return plan;
}

}  // namespace tactus::reconstruct
