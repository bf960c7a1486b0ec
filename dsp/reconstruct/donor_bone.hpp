// SPDX-License-Identifier: Apache-2.0
// The donor of a fibula plan: its line, and what of its surface lies along it.
#pragma once

#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/section.hpp"
#include "dsp/reconstruct/slabs.hpp"

#include <cstddef>
#include <limits>
#include <optional>

namespace tactus::reconstruct {

/// Extent along the line, from line_point.
struct Extent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

    void add(double s) { low = std::min(low, s), high = std::max(high, s); }
};

/// What a plan needs of the donor that does not depend on the jaw's planes, the roll or which end is where: it is made
/// once for all plans of one donor. Not for several threads at once.
class DonorBone {
public:
    /// Takes line, leg, farthest_from_line and donor of the inputs. Throws Error for a line that is none or runs from
    /// front to back, and for a donor that does not lie along it.
    explicit DonorBone(const FibulaInputs& inputs);
    /// The same with a surface that is known to lie along the line, in place of the inputs' donor.
    DonorBone(const FibulaInputs& inputs, geometry::TriangleSurface along_line);
    DonorBone(const DonorBone&) = delete;
    DonorBone& operator=(const DonorBone&) = delete;

    const Vec3& axis() const { return axis_; }  ///< unit, from distal to proximal
    const Mat3& frame() const { return frame_; }  ///< x medial, z along the line
    Leg leg() const { return leg_; }
    bool has_surface() const { return slabs_.has_value(); }
    const geometry::TriangleSurface& surface() const { return bone_; }  ///< what lies along the line; empty: none given
    const Extent& whole() const { return whole_; }

    double along(const Vec3& p) const;
    Vec3 at(double s) const { return point_ + s * axis_; }
    Extent extent(const Section& section) const;

    /// Round the line; empty where the plane misses the bone. Needs a surface.
    Section section(const Plane& plane) const { return slabs_->section(plane, &plane.origin); }
    /// The same for a cut of a segment. Throws Error when the plane does not meet the bone round the line.
    Section cut(const Plane& plane, std::size_t segment) const;

private:
    void take(geometry::TriangleSurface along_line);

    Vec3 point_, axis_;
    Leg leg_;
    double farthest_from_line_;
    Mat3 frame_{1.0};
    geometry::TriangleSurface bone_;
    std::optional<Slabs> slabs_;  // of bone_
    Extent whole_{};
};

}  // namespace tactus::reconstruct
