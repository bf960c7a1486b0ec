// SPDX-License-Identifier: Apache-2.0
// Detects whether two placed bones overlap.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>

namespace tactus::fit {

/// A bone at its current or intended position: surface points and distances, each with the pose of its frame.
struct PlacedBone {
    std::span<const contact::SurfacePoint> points;
    const contact::Voxmap* map = nullptr;
    Pose points_pose, map_pose;
};

/// Returns whether the overlap exceeds the difference of two scans of one surface: more than 10 mm² deeper than `depth`
/// and than a voxel of both. Does not allocate.
bool lie_in_each_other(const PlacedBone& a, const PlacedBone& b, double depth) noexcept;

/// Returns whether both are the same bone, from one file or two: nine tenths of the surface of each lie within a voxel
/// of the other's. Does not allocate.
bool are_one_bone(const PlacedBone& a, const PlacedBone& b) noexcept;

}  // namespace tactus::fit
