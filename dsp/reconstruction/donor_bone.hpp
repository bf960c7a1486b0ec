// SPDX-License-Identifier: Apache-2.0
// The donor of a fibula plan: its axis, and its surface along that axis.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/section.hpp"
#include "dsp/reconstruction/slabs.hpp"

#include <cstddef>
#include <limits>
#include <optional>

namespace tactus::reconstruction {

/// Extent along the line, from line_point.
struct Extent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

    void add(double s) { low = std::min(low, s), high = std::max(high, s); }
};

/// Data of the donor that does not depend on the planes of the jaw, the roll or the direction. It is computed once for
/// all plans of one donor. Not thread-safe.
class DonorBone {
public:
    /// Uses line, leg, farthest_from_line and donor of the inputs. Throws Error for an invalid line or one from front
    /// to back, and for a donor that does not lie along it.
    explicit DonorBone(const FibulaInputs& inputs);
    /// The same with a surface that already lies along the line, instead of the inputs' donor.
    DonorBone(const FibulaInputs& inputs, geometry::TriangleSurface along_line);
    DonorBone(const DonorBone&) = delete;
    DonorBone& operator=(const DonorBone&) = delete;

    const Vec3& axis() const { return axis_; }  ///< unit, from distal to proximal
    const Mat3& frame() const { return frame_; }  ///< x medial, z along the line
    Leg leg() const { return leg_; }
    bool has_surface() const { return slabs_.has_value(); }
    const geometry::TriangleSurface& surface() const { return bone_; }  ///< the parts along the line; empty: none given
    const Extent& whole() const { return whole_; }

    double along(const Vec3& p) const;
    Vec3 at(double s) const { return point_ + s * axis_; }
    Extent extent(const Section& section) const;

    /// Returns the section around the line; empty if the plane misses the bone. Needs a surface.
    Section section(const Plane& plane) const { return slabs_->section(plane, &plane.origin); }
    /// The same for a cut of a segment. Throws Error if the plane does not meet the bone around the line.
    Section cut(const Plane& plane, std::size_t segment) const;

private:
    void take(geometry::TriangleSurface along_line);

    Vec3 point_, axis_;
    Leg leg_;
    double farthest_from_line_;
    Mat3 frame_{1.0};
    geometry::TriangleSurface bone_;
    std::optional<Slabs> slabs_;  // index of bone_
    Extent whole_{};
};

}  // namespace tactus::reconstruction
