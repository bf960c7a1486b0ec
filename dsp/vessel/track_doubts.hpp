// SPDX-License-Identifier: Apache-2.0
// Whether a whole track can be a vessel. Each step of a track is judged beside the steps before it, so that an error that
// grows slowly passes; these checks look at the track as a whole.
#pragma once

#include "dsp/vessel/scan.hpp"
#include "dsp/vessel/track.hpp"

#include <string>
#include <vector>

namespace tactus::vessel {

/// One sentence per branch and reason, none for a sound track. Lengths count along the branch, without lost stretches:
///
/// - it is as wide as `max_radius` allows on a quarter of its length: the vessel is wider, or the track fills something that
///   has no wall;
/// - its radius changes by more than half within one radius on a quarter of its length;
/// - on half of its length there is no wall: the median of the scan at 0.6 radii from the axis is above the lower quartile
///   at 1.5 radii by less than 0.3 of the contrast at the seed. Of a ring around the vessel a quarter is free of neighbours
///   even beside bone, while a plateau is bright on all sides, as the background of a phase-contrast angiogram is.
///
/// The shares are placeholders: the phantoms of `tactus bench vessel` stay below a fifth of each.
std::vector<std::string> doubts_of(const Scan& scan, const Track& track, double max_radius);

}  // namespace tactus::vessel
