// SPDX-License-Identifier: Apache-2.0
// Default threshold of bone in a CT, used when the user gives none.
#pragma once

#include "assets/volume/reoriented_volume.hpp"
#include "dsp/volume/histogram.hpp"

#include <optional>
#include <string>

namespace tactus::bone {

struct CtThreshold {
    double value = 0.0;  ///< in the unit of the histogram: HU, or scanner numbers; an integer if the range is wide
    std::string how;     ///< description of the method
    double exact = 0.0;  ///< before rounding: scales with the values, so that HU and HU / 1000 give the same bone
};

/// Returns the histogram that suggested_threshold needs; `low`, `high`: minimum and maximum of the volume.
volume::Histogram threshold_histogram(double low, double high);
/// The same, filled by reading a volume once more, a few layers at a time. The volume must be settled.
volume::Histogram threshold_histogram(volume::ReorientedVolume& source);

/// Returns the threshold that `info` prints and `import` uses. `stated`: HU of the surface in an exported bone
/// (ScanVolume::surface_hu), which is used as it is: the histogram of a bone without soft tissue does not show it. HU:
/// volume::split_hu, or 300 HU if that finds no soft tissue or would be below 100 HU, where soft tissue is.
CtThreshold suggested_threshold(const volume::Histogram& histogram, volume::HuKind hu,
                                std::optional<double> stated = {});

}  // namespace tactus::bone
