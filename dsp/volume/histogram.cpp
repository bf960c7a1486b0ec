// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/histogram.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>

namespace tactus::volume {

Histogram histogram_of(std::span<const float> values, std::size_t bins) {
    if (values.empty()) return empty_histogram(0.0, 0.0, bins);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    Histogram histogram = empty_histogram(double(*low), double(*high), bins);
    add_values(histogram, values);
    return histogram;
}

Histogram empty_histogram(double low, double high, std::size_t bins) {
    Histogram histogram{low, high, {}};
    histogram.counts.assign(bins, 0);
    return histogram;
}

void add_values(Histogram& histogram, std::span<const float> values) {
    const std::size_t bins = histogram.counts.size();
    const double scale =
        histogram.high > histogram.low ? static_cast<double>(bins) / (histogram.high - histogram.low) : 0.0;
    constexpr std::size_t at_once = std::size_t{1} << 20;
    for (std::size_t at = 0; at < values.size(); at += at_once) {
        leave_if_stopped();
        for (const float value : values.subspan(at, std::min(at_once, values.size() - at)))
            ++histogram.counts[std::min(
                bins - 1, static_cast<std::size_t>(std::max(0.0, (double(value) - histogram.low) * scale)))];
    }
}

std::size_t otsu(const Histogram& histogram, std::size_t first, std::size_t end) {
    end = std::min(end, histogram.counts.size());
    double all = 0.0, sum = 0.0;
    for (std::size_t n = first; n < end; ++n) {
        all += static_cast<double>(histogram.counts[n]);
        sum += static_cast<double>(histogram.counts[n]) * histogram.middle(n);
    }
    double below = 0.0, sum_below = 0.0, best = -1.0;
    std::size_t border = first;
    for (std::size_t n = first; n + 1 < end; ++n) {
        below += static_cast<double>(histogram.counts[n]);
        sum_below += static_cast<double>(histogram.counts[n]) * histogram.middle(n);
        const double above = all - below;
        if (below <= 0.0 || above <= 0.0) continue;
        const double apart = sum_below / below - (sum - sum_below) / above;
        const double between = below * above * apart * apart;
        if (between > best) best = between, border = n + 1;
    }
    return border;
}

namespace {

/// Mean of the values in the bins [first, end); the lower edge of `first` if they are empty.
double mean_of(const Histogram& histogram, std::size_t first, std::size_t end) {
    double count = 0.0, sum = 0.0;
    for (std::size_t n = first; n < end; ++n) {
        count += static_cast<double>(histogram.counts[n]);
        sum += static_cast<double>(histogram.counts[n]) * histogram.middle(n);
    }
    return count > 0.0 ? sum / count : histogram.low + static_cast<double>(first) * histogram.width();
}

double edge_of(const Histogram& histogram, std::size_t bin) {
    return histogram.low + static_cast<double>(bin) * histogram.width();
}

}  // namespace

TissueSplit split_hu(const Histogram& histogram) {
    std::size_t end = histogram.counts.size();
    while (end > 0 && histogram.middle(end - 1) > min_metal_hu) --end;
    TissueSplit split;
    std::size_t first = 0, border = otsu(histogram, 0, end);
    while (border > first && mean_of(histogram, first, border) < max_air_hu) {
        split.has_air = true;
        first = border;
        border = otsu(histogram, first, end);
    }
    split.has_soft_tissue = border > first && mean_of(histogram, first, border) < max_soft_tissue_hu;
    split.threshold = edge_of(histogram, border);
    return split;
}

double split_scanner_values(const Histogram& histogram) { return edge_of(histogram, otsu(histogram, otsu(histogram))); }

double half_of_median(const Histogram& histogram) {
    std::uint64_t above = 0, seen = 0;
    for (std::size_t n = 0; n < histogram.counts.size(); ++n)
        if (histogram.middle(n) > histogram.width()) above += histogram.counts[n];
    for (std::size_t n = 0; n < histogram.counts.size(); ++n) {
        if (histogram.middle(n) <= histogram.width()) continue;
        seen += histogram.counts[n];
        if (2 * seen >= above && above > 0) return 0.5 * histogram.middle(n);
    }
    return histogram.high;
}

}  // namespace tactus::volume
