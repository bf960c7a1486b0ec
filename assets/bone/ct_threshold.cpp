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

CtThreshold suggested_threshold(const volume::Histogram& histogram, volume::HuKind hu) {
    const bool masked = hu == volume::HuKind::masked;
    const double value = volume::suggested_threshold(histogram, masked);
    // Where bone is rare or absent the second split lies between soft tissues.
    if (hu == volume::HuKind::calibrated && value < min_of_bone)
        return {common_for_bone, "common for bone; the values alone do not tell it from soft tissue", common_for_bone};
    const bool is_wide = histogram.high - histogram.low > 200.0;
    return {is_wide ? std::round(value) : value,
            masked ? "half the median of the values that are not 0" : "Otsu's method twice: first air, then bone",
            value};
}

}  // namespace tactus::bone
