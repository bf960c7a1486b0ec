// SPDX-License-Identifier: Apache-2.0
// Whether two placed bones lie in each other.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>

namespace tactus::fit {

/// A bone where it is, or would be: surface points and distances, each with the pose of its frame.
struct PlacedBone {
    std::span<const contact::SurfacePoint> points;
    const contact::Voxmap* map = nullptr;
    Pose points_pose, map_pose;
};

/// Whether more of the surface of one lies in the other than two scans of the same surface differ by: 10 mm² deeper
/// than `depth` and than a voxel of both. Does not allocate.
bool lie_in_each_other(const PlacedBone& a, const PlacedBone& b, double depth) noexcept;

/// Whether both are one bone, from one file or two: nine tenths of the surface of each lie within a voxel of the other's.
/// Does not allocate.
bool are_one_bone(const PlacedBone& a, const PlacedBone& b) noexcept;

}  // namespace tactus::fit
