// SPDX-License-Identifier: Apache-2.0
// Detects fits that only repeat the scanned position. Where fragments touch in a scan, a label border is drawn through
// the bone and both get the same surface: it fits itself to a fraction of a voxel, wherever the fragments were moved.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>

namespace tactus::fit {

struct AsScannedSettings {
    double moved = 1e-3;  ///< m: greatest root mean square displacement of the touching points
    double touching = 0.3e-3;  ///< m: nearer surfaces with opposite normals touch
    double share = 0.5;  ///< of the area that touches in the fit: at least this much touches in the scan
    double least_area = 10e-6;  ///< m² that touch in the scan: less is chance
};

/// Whether two fragments of one scan already touch, at their poses in the files, where a fit puts them. `points` of one
/// fragment, with areas; `place` maps them to the frame of the other, whose distances are `other`; `scanned` maps them
/// to their scanned position there. Fragments of unrelated files touch there only by chance. Does not allocate; two
/// samples per point.
bool is_as_scanned(std::span<const contact::SurfacePoint> points, const Pose& place, const contact::Voxmap& other,
                   const Pose& scanned = {}, const AsScannedSettings& settings = {}) noexcept;

}  // namespace tactus::fit
