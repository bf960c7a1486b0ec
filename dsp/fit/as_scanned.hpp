// SPDX-License-Identifier: Apache-2.0
// Detects fits that only reproduce the scanned position. Where fragments touch in a scan, the segmentation draws a
// border through the bone and both get the same surface. It matches itself to a fraction of a voxel, at any pose of the
// fragments.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>

namespace tactus::fit {

struct AsScannedSettings {
    double moved = 1e-3;  ///< m: greatest root mean square displacement of the touching points
    double touching = 0.3e-3;  ///< m: surfaces closer than this with opposite normals are in contact
    double share = 0.5;  ///< minimum fraction of the contact area of the fit that is also in contact in the scan
    double min_area = 10e-6;  ///< m² in contact in the scan: less is chance
};

/// Returns whether two fragments of one scan already touch, at the poses in their files, where a fit places them.
/// `points` of one fragment, with areas; `place` maps them to the frame of the other, whose distances are `other`;
/// `scanned` maps them to their scanned position there. Fragments of unrelated files touch there only by chance. Does
/// not allocate; two samples per point.
bool is_as_scanned(std::span<const contact::SurfacePoint> points, const Pose& place, const contact::Voxmap& other,
                   const Pose& scanned = {}, const AsScannedSettings& settings = {}) noexcept;

}  // namespace tactus::fit
