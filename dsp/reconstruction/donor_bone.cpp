// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/donor_bone.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/plan_frame.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <utility>

namespace tactus::reconstruction {

DonorBone::DonorBone(const FibulaInputs& inputs) : DonorBone(inputs, {}) {
    if (inputs.donor) take(parts_near_line(*inputs.donor, point_, axis_, farthest_from_line_));
}

DonorBone::DonorBone(const FibulaInputs& inputs, geometry::TriangleSurface along_line)
    : point_(inputs.line_point),
      axis_(direction(inputs.line_direction, "the line's direction")),
      leg_(inputs.leg),
      farthest_from_line_(inputs.farthest_from_line) {
    if (!is_finite(point_)) throw Error("the line's point is no point");
    // x = y × z must be medial.
    const Vec3 y = leg_ == Leg::left ? Vec3(0.0, -1.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    if (glm::length(glm::cross(y, axis_)) < min_y)
        throw Error("the line runs from front to back: that does not tell the medial side of the donor");
    frame_ = frame_of(axis_, y);
    if (!along_line.vertices.empty()) take(std::move(along_line));
}

void DonorBone::take(geometry::TriangleSurface along_line) {
    bone_ = std::move(along_line);
    for (const Vec3& v : bone_.vertices) whole_.add(along(v));
    slabs_.emplace(bone_, point_, axis_);
}

double DonorBone::along(const Vec3& p) const { return glm::dot(p - point_, axis_); }

Extent DonorBone::extent(const Section& section) const {
    Extent out;
    for (const Vec3& p : section.points) out.add(along(p));
    return out;
}

Section DonorBone::cut(const Plane& plane, std::size_t segment) const {
    Section found = section(plane);
    const double s = along(plane.origin);
    if (found.points.empty())
        throw Error(
            fmt::format("segment {}: a cut {:.1f} mm along the line misses the donor, which reaches from {:.1f} to "
                        "{:.1f} mm",
                        segment + 1, s / mm, whole_.low / mm, whole_.high / mm));
    const Vec3 aside = found.centre - at(along(found.centre));
    if (glm::length(aside) > farthest_from_line_)
        throw Error(
            fmt::format("segment {}: {:.1f} mm along the line the donor's centre is {:.1f} mm away from it, more than "
                        "{:.1f} mm; the donor must be straight there and the line must follow it",
                        segment + 1, s / mm, glm::length(aside) / mm, farthest_from_line_ / mm));
    return found;
}

}  // namespace tactus::reconstruction
