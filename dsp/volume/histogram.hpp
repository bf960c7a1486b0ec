// SPDX-License-Identifier: Apache-2.0
// Histograms and Otsu's threshold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// Counts of values in bins of equal width between minimum and maximum.
struct Histogram {
    double low = 0.0, high = 0.0;
    std::vector<std::uint64_t> counts;

    double width() const { return (high - low) / static_cast<double>(counts.size()); }
    double middle(std::size_t bin) const { return low + (static_cast<double>(bin) + 0.5) * width(); }
};
Histogram histogram_of(std::span<const float> values, std::size_t bins);
/// Returns empty bins between `low` and `high`, to be filled by add_values; values beyond count in the first or last
/// bin.
Histogram empty_histogram(double low, double high, std::size_t bins);
void add_values(Histogram& histogram, std::span<const float> values);

/// Otsu's threshold (1979) among the bins from `first` on: it minimises the variance within both groups. Returns the
/// index of the first bin above it; `first` when all values are in one bin.
std::size_t otsu(const Histogram& histogram, std::size_t first = 0);

/// A threshold between bone and the rest of a CT: Otsu's method twice, first to separate air, then to split the
/// rest. In a masked volume (zeros around the bone): half the median of the values above zero.
double suggested_threshold(const Histogram& histogram, bool masked);

}  // namespace tactus::volume
