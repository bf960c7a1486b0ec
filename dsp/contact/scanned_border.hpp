// SPDX-License-Identifier: Apache-2.0
// Borders where fragments touch in their scan. The segmentation draws them through the bone, so they are not fracture
// surfaces.
#pragma once

#include "dsp/contact/pointshell.hpp"

#include <span>
#include <vector>

namespace tactus::contact {

/// The border between the label of a bone and other labels. Both bones get the same surface there, which matches itself
/// at any pose; therefore fits must ignore it.
struct ScannedBorder {
    std::vector<Vec3> faces;  ///< m, frame of the bone: middles of the voxels' faces between the labels
    Vec3 voxel{0.0};  ///< m, spacing of these voxels
};

/// Labels the points within 1.25 voxels of a face as `surface_label::as_scanned`, regardless of their label. The
/// tolerance is needed because a smoothed surface deviates from its voxels' faces by up to one voxel. Returns the
/// number of these points.
std::size_t mark_as_scanned(std::span<SurfacePoint> points, const ScannedBorder& border);

/// Removes all labels but `as_scanned`.
void remove_paint(std::span<SurfacePoint> points) noexcept;

/// Returns the area in m² of the points labelled `as_scanned`.
double as_scanned_area(std::span<const SurfacePoint> points) noexcept;

}  // namespace tactus::contact
