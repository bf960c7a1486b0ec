// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/ct_threshold.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::bone {

namespace {

constexpr double min_of_bone = 100.0, common_for_bone = 300.0;  // HU

}  // namespace

volume::Histogram threshold_histogram(double low, double high) { return volume::empty_histogram(low, high, 2048); }

volume::Histogram threshold_histogram(volume::ReorientedVolume& source) {
    constexpr int at_once = 16;
    const auto [low, high] = source.range();
    volume::Histogram histogram = threshold_histogram(low, high);
    const int layers = source.layout().size[2];
    for (int k = 0; k < layers; k += at_once)
        volume::add_values(histogram, source.layers(k, std::min(at_once, layers - k)).values);
    return histogram;
}

CtThreshold suggested_threshold(const volume::Histogram& histogram, volume::HuKind hu, std::optional<double> stated) {
    if (stated) return {*stated, "the surface of an exported bone, as the file states it", *stated};
    const bool is_wide = histogram.high - histogram.low > 200.0;
    const auto found = [is_wide](double value, const char* how) {
        return CtThreshold{is_wide ? std::round(value) : value, how, value};
    };
    if (hu == volume::HuKind::masked)
        return found(volume::half_of_median(histogram), "half the median of the values that are not 0");
    if (hu != volume::HuKind::calibrated)
        return found(volume::split_scanner_values(histogram), "Otsu's method twice: first air, then bone");
    const volume::TissueSplit split = volume::split_hu(histogram);
    if (!split.has_soft_tissue)
        return {common_for_bone, "common for bone; the values show no soft tissue around it", common_for_bone};
    // Where bone is rare or absent the last split lies between soft tissues.
    if (split.threshold < min_of_bone)
        return {common_for_bone, "common for bone; soft tissue may have the same values", common_for_bone};
    return found(split.threshold, split.has_air ? "Otsu's method, after air was split off" : "Otsu's method");
}

}  // namespace tactus::bone
