// SPDX-License-Identifier: Apache-2.0
// The CT number from which on a voxel is bone, when the user gives none.
#pragma once

#include "assets/volume/reoriented_volume.hpp"
#include "dsp/volume/histogram.hpp"

#include <string>

namespace tactus::bone {

struct CtThreshold {
    double value = 0.0;  ///< in the unit of the histogram: HU, or scanner numbers; whole where the range is wide
    std::string how;     ///< the method, in words
    double exact = 0.0;  ///< before rounding: scales with the values, so that HU and HU / 1000 have the same bone
};

/// The histogram that suggested_threshold needs; `low`, `high`: least and greatest value of the volume.
volume::Histogram threshold_histogram(double low, double high);
/// The same, filled by reading a volume once more, a few layers at a time. The volume must be settled.
volume::Histogram threshold_histogram(volume::ReorientedVolume& source);

/// The threshold that `info` suggests and `import` uses: volume::suggested_threshold, or 300 HU when that would be
/// below 100 HU, where soft tissue is.
CtThreshold suggested_threshold(const volume::Histogram& histogram, volume::HuKind hu);

}  // namespace tactus::bone
