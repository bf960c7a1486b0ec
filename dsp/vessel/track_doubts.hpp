// SPDX-License-Identifier: Apache-2.0
// Plausibility of a whole track as a vessel. Each step of a track is compared only with previous steps, so that a
// slowly growing error passes; these checks evaluate the track as a whole.
#pragma once

#include "dsp/vessel/scan.hpp"
#include "dsp/vessel/track.hpp"

#include <string>
#include <vector>

namespace tactus::vessel {

/// Returns one sentence per branch and reason, none for a plausible track. Lengths are measured along the branch,
/// without lost stretches:
///
/// - it is as wide as `max_radius` allows over a quarter of its length: the vessel is wider, or the track fills a
///   region without a wall;
/// - its radius changes by more than half within one radius over a quarter of its length;
/// - over half of its length there is no wall: the median of the scan at 0.6 radii from the axis exceeds the lower
///   quartile at 1.5 radii by less than 0.3 of the contrast at the seed. The quartile is used because a quarter of the
///   ring around a vessel is free of neighbours even beside bone, while a plateau is bright on all sides, as is the
///   background of a phase-contrast angiogram.
///
/// The fractions are placeholders: the phantoms of `tactus bench vessel` stay below a fifth of each.
std::vector<std::string> doubts_of(const Scan& scan, const Track& track, double max_radius);

}  // namespace tactus::vessel
