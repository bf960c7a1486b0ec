// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/fibula_plan.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/jaw_side.hpp"
#include "dsp/reconstruction/plan_frame.hpp"
#include "dsp/reconstruction/plan_measures.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::reconstruction {

namespace {

/// A segment whose axis meets its more distal plane `start` along the line.
FibulaSegment segment_at(const FibulaInputs& inputs, const JawSide& jaw, const DonorBone& donor, std::size_t n,
                         double start) {
    const Plane &first = jaw.planes[n], &last = jaw.planes[n + 1];
    FibulaSegment segment;
    segment.length_centre = glm::length(last.origin - first.origin);
    const Mat3 turn = frame_of(jaw.axis[n], jaw.y[n]) * glm::transpose(donor.frame());
    const Vec3 jaw_axis = inputs.reversed ? -jaw.axis[n] : jaw.axis[n];
    const Quat orientation =
        glm::normalize(glm::angleAxis(inputs.roll, jaw_axis) * glm::normalize(glm::quat_cast(turn)));
    segment.donor_to_target = {first.origin - orientation * donor.at(start), orientation};
    segment.along_line = {start, start + segment.length_centre};
    const Quat back = glm::conjugate(orientation);
    for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 normal = back * jaw.planes[n + end].normal;
        segment.donor_plane[end] = {donor.at(segment.along_line[end]), normal};
        segment.tilt[end] = angle_between(normal, donor.axis());
        const Vec3 medial = donor.frame()[0],
                   anterior = donor.leg() == Leg::left ? donor.frame()[1] : -donor.frame()[1];
        segment.lean_medial[end] = std::atan2(glm::dot(normal, medial), glm::dot(normal, donor.axis()));
        segment.lean_anterior[end] = std::atan2(glm::dot(normal, anterior), glm::dot(normal, donor.axis()));
    }
    segment.end_angle = angle_between(segment.donor_plane[0].normal, segment.donor_plane[1].normal);
    return segment;
}

/// The start at which the lowest point of the segment's first section lies `low` along the line. The section changes
/// with its place, so the start is found by iteration.
double start_for(const FibulaInputs& inputs, const JawSide& jaw, const DonorBone& donor, std::size_t n, double low) {
    double start = low;
    for (int round = 0; round < 30; ++round) {
        const Plane plane = segment_at(inputs, jaw, donor, n, start).donor_plane[0];
        const Section section = donor.section(plane);
        // Just below the bone's end there is no section yet.
        const double change = section.points.empty() ? 1.0 * mm : low - donor.extent(section).low;
        start += change;
        if (std::abs(change) < 1e-7) break;
    }
    return start;
}

/// Lengths between the outlines of the segment's two sections. Both planes are graphs over the cross-section: the
/// length at an outline point is that between them.
void measure_lengths(FibulaSegment& segment, const DonorBone& donor, const std::array<Section, 2>& sections) {
    Extent lengths;
    const auto reach = [&](const Plane& plane, const Vec3& p) {
        return glm::dot(plane.normal, plane.origin - p) / glm::dot(plane.normal, donor.axis());
    };
    for (const Section& section : sections)
        for (const Vec3& p : section.points)
            lengths.add(reach(segment.donor_plane[1], p) - reach(segment.donor_plane[0], p));
    segment.length_shortest = lengths.low;
    segment.length_longest = lengths.high;
}

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

FibulaPlan plan_fibula(const FibulaInputs& inputs) { return plan_fibula(inputs, DonorBone(inputs)); }

FibulaPlan plan_fibula(const FibulaInputs& inputs, const DonorBone& donor) {
    const JawSide jaw = jaw_side(inputs);
    const std::size_t count = jaw.axis.size();
    if (!(inputs.kerf >= 0.0 && inputs.kerf < 0.01)) throw Error("the kerf must be 0 to 10 mm");
    if (!std::isfinite(inputs.roll)) throw Error("the roll of the donor is no angle");
    const std::vector<double> places = places_of(inputs, count);
    const auto jaw_number = [&](std::size_t n) { return inputs.reversed ? count - 1 - n : n; };
    FibulaPlan plan;
    double free_from = donor.has_surface() ? donor.whole().low + inputs.distal_margin : 0.0;
    Extent used;
    Cuts cuts;
    for (std::size_t n = 0; n < count; ++n) {
        leave_if_stopped();
        const double start = !places.empty()       ? places[n]
                             : donor.has_surface() ? start_for(inputs, jaw, donor, n, free_from)
                                                   : free_from;
        plan.segments.push_back(segment_at(inputs, jaw, donor, n, start));
        FibulaSegment& segment = plan.segments.back();
        free_from = segment.along_line[1] + inputs.between;
        if (!donor.has_surface()) {
            if (n > 0) plan.clearances.push_back({});
            continue;
        }
        cuts.push_back(
            {donor.cut(segment.donor_plane[0], jaw_number(n)), donor.cut(segment.donor_plane[1], jaw_number(n))});
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
    if (donor.has_surface()) {
        plan.left_distal = used.low - donor.whole().low;
        plan.left_proximal = donor.whole().high - used.high;
    }
    if (inputs.reversed) to_jaw_order(plan, cuts);
    measure_faces(plan, inputs, cuts);
    measure_joints(plan, jaw.off_bisector, donor);
    warn_of(plan, inputs, donor);
    return plan;
}

}  // namespace tactus::reconstruction
