// SPDX-License-Identifier: Apache-2.0
#include "dsp/segment/gap_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tactus::segment {

namespace {

/// The value below which `share` of the sorted values lie. Equal values count as spread evenly about their value: the
/// distribution is linear between the middles of the groups of equal values.
double quantile(const std::vector<float>& sorted, double share) {
    if (sorted.empty()) return 0.0;
    const double wanted = share * static_cast<double>(sorted.size());
    const auto middle = [&](float value) {
        const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), value);
        return 0.5 * static_cast<double>((low - sorted.begin()) + (high - sorted.begin()));
    };
    const std::size_t at = std::min(static_cast<std::size_t>(wanted), sorted.size() - 1);
    const float here = sorted[at];
    const double here_middle = middle(here);
    // The neighbouring group on the side of the wanted count.
    if (wanted < here_middle) {
        const auto low = std::lower_bound(sorted.begin(), sorted.end(), here);
        if (low == sorted.begin()) return static_cast<double>(here);
        const float other = *(low - 1);
        const double t = (here_middle - wanted) / (here_middle - middle(other));
        return static_cast<double>(here) + t * (static_cast<double>(other) - static_cast<double>(here));
    }
    const auto high = std::upper_bound(sorted.begin(), sorted.end(), here);
    if (high == sorted.end()) return static_cast<double>(here);
    const double t = (wanted - here_middle) / (middle(*high) - here_middle);
    return static_cast<double>(here) + t * (static_cast<double>(*high) - static_cast<double>(here));
}

}  // namespace

GapStatistics gap_statistics(const volume::Grid& values, std::span<const std::uint8_t> inside) {
    std::vector<float> sorted, residues;
    for (std::size_t v = 0; v < inside.size(); ++v)
        if (inside[v] != 0) sorted.push_back(values.values[v]);
    std::sort(sorted.begin(), sorted.end());

    // The weights of the operator: 1 -2 1, -2 4 -2, 1 -2 1. Their squares sum to 36.
    const auto row = static_cast<std::ptrdiff_t>(values.size[0]);
    const std::array<std::pair<std::ptrdiff_t, float>, 9> taps{{{-row - 1, 1.0f},
                                                                {-row, -2.0f},
                                                                {-row + 1, 1.0f},
                                                                {-1, -2.0f},
                                                                {0, 4.0f},
                                                                {1, -2.0f},
                                                                {row - 1, 1.0f},
                                                                {row, -2.0f},
                                                                {row + 1, 1.0f}}};
    for (int k = 0; k < values.size[2]; ++k)
        for (int j = 1; j + 1 < values.size[1]; ++j)
            for (int i = 1; i + 1 < values.size[0]; ++i) {
                const auto v = static_cast<std::ptrdiff_t>(values.index(i, j, k));
                float sum = 0.0f;
                bool whole = true;
                for (const auto& [offset, weight] : taps) {
                    const auto at = static_cast<std::size_t>(v + offset);
                    whole = whole && inside[at] != 0;
                    sum += weight * values.values[at];
                }
                if (whole) residues.push_back(std::abs(sum));
            }
    std::sort(residues.begin(), residues.end());
    constexpr double median_of_normal = 0.67449;
    return {quantile(sorted, 0.05), quantile(sorted, 0.6), quantile(residues, 0.5) / 6.0 / median_of_normal};
}

GapLaw gap_law(const GapStatistics& statistics) {
    const double range = statistics.bright - statistics.dark;
    GapLaw law;
    law.bright = statistics.bright;
    // All voxels alike: any width will do, as no conductance differs from another.
    law.width = range > 0.0 || statistics.noise > 0.0 ? std::max(2.0 * statistics.noise, 0.05 * range) : 1.0;
    return law;
}

GapLaw law_of_seeds(const GapLaw& law, const VoxelGraph& graph, const volume::Grid& values,
                    std::span<const std::uint8_t> seed) {
    std::array<std::vector<float>, 256> painted;
    for (std::size_t n = 0; n < seed.size(); ++n)
        if (seed[n] != 0) painted[seed[n]].push_back(values.values[graph.voxel[n]]);
    GapLaw out = law;
    for (std::vector<float>& of_label : painted) {
        if (of_label.empty()) continue;
        std::sort(of_label.begin(), of_label.end());
        out.bright = std::min(out.bright, quantile(of_label, 0.9));
    }
    return out;
}

}  // namespace tactus::segment
