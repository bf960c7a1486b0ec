// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/gap_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tactus::segmentation {

namespace {

/// The value below which `share` of the sorted values lie. Equal values count as spread evenly about their value: the
/// distribution is linear between the middles of the groups of equal values. Values up to `rounding` apart are equal: whole
/// numbers that were scaled differ in their last bits where they did not before.
double quantile(const std::vector<float>& sorted, double share, double rounding) {
    if (sorted.empty()) return 0.0;
    const double wanted = share * static_cast<double>(sorted.size());
    const auto first_of = [&](double value) {
        return std::lower_bound(sorted.begin(), sorted.end(), static_cast<float>(value - rounding));
    };
    const auto behind = [&](double value) {
        return std::upper_bound(sorted.begin(), sorted.end(), static_cast<float>(value + rounding));
    };
    const auto middle = [&](double value) {
        return 0.5 * static_cast<double>((first_of(value) - sorted.begin()) + (behind(value) - sorted.begin()));
    };
    const std::size_t at = std::min(static_cast<std::size_t>(wanted), sorted.size() - 1);
    const auto here = static_cast<double>(sorted[at]);
    const double here_middle = middle(here);
    // The neighbouring group on the side of the wanted count.
    double other = here;
    if (wanted < here_middle) {
        if (const auto low = first_of(here); low != sorted.begin()) other = static_cast<double>(*(low - 1));
    } else if (const auto high = behind(here); high != sorted.end()) other = static_cast<double>(*high);
    const double apart = middle(other) - here_middle;
    return apart == 0.0 ? here : here + (wanted - here_middle) / apart * (other - here);
}

/// What rounding to floats changes in sums of a few of these values, with room.
double rounding_of(const std::vector<float>& sorted) {
    if (sorted.empty()) return 0.0;
    const double most =
        std::max(std::abs(static_cast<double>(sorted.front())), std::abs(static_cast<double>(sorted.back())));
    return 1e-5 * most;
}

/// Least distance of two values that differ; 0: there is but one.
double step_of(const std::vector<float>& sorted, double rounding) {
    double least = 0.0;
    for (std::size_t n = 1; n < sorted.size(); ++n) {
        const double apart = static_cast<double>(sorted[n]) - static_cast<double>(sorted[n - 1]);
        if (apart > rounding && (least == 0.0 || apart < least)) least = apart;
    }
    return least;
}

/// Rounding to steps adds a twelfth of the squared step to the variance (Sheppard 1898).
double without_steps(double noise, double step) { return std::sqrt(std::max(0.0, noise * noise - step * step / 12.0)); }

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
    const double rounding = rounding_of(sorted);
    return {quantile(sorted, 0.05, rounding), quantile(sorted, 0.6, rounding),
            without_steps(quantile(residues, 0.5, rounding) / 6.0 / median_of_normal, step_of(sorted, rounding))};
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
        out.bright = std::min(out.bright, quantile(of_label, 0.9, rounding_of(of_label)));
    }
    return out;
}

}  // namespace tactus::segmentation
