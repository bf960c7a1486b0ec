// SPDX-License-Identifier: Apache-2.0
// The first vessel on a line of sight. No user interface.
#pragma once

#include "tools/analysis/segmentation/segment_scan.hpp"

namespace tactus::window {

struct RayMeets {
    enum class What { nothing, vessel, bone } what = What::nothing;
    Vec3 at{0.0};            ///< m; of a vessel: a place inside of it
    bool may_be_bone = false;  ///< a vessel as bright as the threshold of bone
};

/// The first bright stretch of a ray from outside of the scan, of at least two samples: a vessel when it stays below the
/// brightness of cortical bone (700 HU, or the threshold where that is higher or values are scanner numbers). Bright is 150
/// HU, or half way from soft tissue to the threshold where that is less; each place counts as the mean of seven samples, so
/// that noise is no vessel. `direction`: unit.
RayMeets first_on_ray(const analysis::ScanGraph& scan, const Vec3& from, const Vec3& direction);

}  // namespace tactus::window
