// SPDX-License-Identifier: Apache-2.0
// Fits that only repeat the scan. Where fragments touch in a scan, a border between two labels is drawn through the bone,
// and both get the same surface: it fits itself to a fraction of a voxel, wherever the fragments were moved to.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <span>

namespace tactus::fit {

struct AsScannedSettings {
    double moved = 1e-3;  ///< m: root mean square way of the points that touch, at most
    double touching = 0.3e-3;  ///< m: nearer surfaces that look against each other touch
    double share = 0.5;  ///< of the area that touches where they fit: so much of it touches in the scan
    double least_area = 10e-6;  ///< m² that touch in the scan: less is chance
};

/// Whether two fragments of one scan already touch, as their files have them, where a fit puts them. `points` of the one,
/// with areas; `place` takes them into the frame of the other, whose distances are `other`, and `scanned` takes them to
/// where the scan has them there. Fragments of files that have nothing to do with each other do not touch there but by
/// chance. Takes no memory: two samples per point.
bool is_as_scanned(std::span<const contact::SurfacePoint> points, const Pose& place, const contact::Voxmap& other,
                   const Pose& scanned = {}, const AsScannedSettings& settings = {}) noexcept;

}  // namespace tactus::fit
