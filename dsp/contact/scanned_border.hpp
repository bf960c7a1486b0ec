// SPDX-License-Identifier: Apache-2.0
// Where fragments touch in their scan: the border that is drawn there through the bone is no fracture surface.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <span>
#include <vector>

namespace tactus::contact {

/// Where the label of a bone met other labels. Both bones get the same surface there, as scanned: it fits itself
/// wherever they are moved to, so that fits leave it out.
struct ScannedBorder {
    std::vector<Vec3> faces;  ///< m, frame of the bone: middles of the voxels' faces between the labels
    Vec3 voxel{0.0};          ///< m, spacing of these voxels
};

/// Labels the points within 1.25 voxels of a face as `surface_label::as_scanned`, whatever label they had: a surface
/// that is smoothed departs from its voxels' faces by up to one voxel. Returns the number of these points.
std::size_t mark_as_scanned(std::span<SurfacePoint> points, const ScannedBorder& border);

/// Removes all labels but `as_scanned`.
void remove_paint(std::span<SurfacePoint> points) noexcept;

/// m² of the points that are as scanned.
double as_scanned_area(std::span<const SurfacePoint> points) noexcept;

}  // namespace tactus::contact
