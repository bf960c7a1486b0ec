// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/resample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::volume {

namespace {

double cubic(double x) {
    x = std::abs(x);
    if (x < 1.0) return (1.5 * x - 2.5) * x * x + 1.0;
    return x < 2.0 ? ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0 : 0.0;
}

struct Taps {
    std::vector<std::size_t> index;
    std::vector<float> weight;
};

Taps taps_at(double u, double width, int size) {
    Taps taps;
    double sum = 0.0;
    std::vector<double> weight;
    for (int n = static_cast<int>(std::floor(u - 2.0 * width)); n <= static_cast<int>(std::ceil(u + 2.0 * width));
         ++n) {
        const double w = cubic((n - u) / width);
        if (w == 0.0) continue;
        taps.index.push_back(static_cast<std::size_t>(std::clamp(n, 0, size - 1)));
        weight.push_back(w);
        sum += w;
    }
    for (const double w : weight) taps.weight.push_back(static_cast<float>(w / sum));
    return taps;
}

Taps taps_of(const Grid& from, const Grid& layout, int axis, int row) {
    const double width = std::max(1.0, layout.spacing[axis] / from.spacing[axis]);
    const double u = (layout.origin[axis] + static_cast<double>(row) * layout.spacing[axis] - from.origin[axis]) /
                     from.spacing[axis];
    return taps_at(u, width, from.size[static_cast<std::size_t>(axis)]);
}

// Rows `wanted` of the result along an axis; `in` holds the rows of `whole` from `held` on.
Grid along(const Grid& in, int held, const Grid& whole, const Grid& layout, int axis, LayerRange wanted,
           const RunJobs& run) {
    const auto a = static_cast<std::size_t>(axis);
    Grid out{in.size, in.origin, in.spacing, {}};
    out.size[a] = wanted.count;
    out.origin[axis] = layout.origin[axis] + wanted.first * layout.spacing[axis];
    out.spacing[axis] = layout.spacing[axis];
    out.values.assign(out.count(), 0.0f);
    // Along this axis a grid is `outer` blocks of size[axis] rows of `stride` adjacent values.
    std::size_t stride = 1, outer = 1;
    for (std::size_t n = 0; n < a; ++n) stride *= static_cast<std::size_t>(in.size[n]);
    for (std::size_t n = a + 1; n < 3; ++n) outer *= static_cast<std::size_t>(in.size[n]);
    const std::size_t from_rows = static_cast<std::size_t>(in.size[a]), to_rows = static_cast<std::size_t>(out.size[a]);
    std::vector<Taps> taps;
    for (int row = wanted.first; row < wanted.first + wanted.count; ++row)
        taps.push_back(taps_of(whole, layout, axis, row));
    const auto add = [&](std::size_t block, std::size_t row) {
        float* to = &out.values[(block * to_rows + row) * stride];
        const bool is_copy = taps[row].index.size() == 1;
        std::vector<float> low, high;
        if (!is_copy) {
            low.assign(stride, std::numeric_limits<float>::infinity());
            high.assign(stride, -std::numeric_limits<float>::infinity());
        }
        for (std::size_t n = 0; n < taps[row].index.size(); ++n) {
            const std::size_t at = taps[row].index[n] - static_cast<std::size_t>(held);
            const float* from = &in.values[(block * from_rows + at) * stride];
            const float weight = taps[row].weight[n];
            for (std::size_t s = 0; s < stride; ++s) to[s] += weight * from[s];
            if (is_copy) return;
            for (std::size_t s = 0; s < stride; ++s)
                low[s] = std::min(low[s], from[s]), high[s] = std::max(high[s], from[s]);
        }
        // A cubic overshoots at edges; values that no sample has are artefacts.
        for (std::size_t s = 0; s < stride; ++s) to[s] = std::clamp(to[s], low[s], high[s]);
    };
    if (outer == 1) run(wanted.count, [&](int row) { add(0, static_cast<std::size_t>(row)); });
    else
        run(in.size[2], [&](int layer) {
            const std::size_t each = outer / static_cast<std::size_t>(in.size[2]);
            for (std::size_t n = 0; n < each; ++n)
                for (std::size_t row = 0; row < to_rows; ++row) add(static_cast<std::size_t>(layer) * each + n, row);
        });
    return out;
}

// True when the axis needs no interpolation and no row is dropped.
bool is_same(const Grid& grid, const Grid& layout, int axis) {
    return grid.size[static_cast<std::size_t>(axis)] == layout.size[static_cast<std::size_t>(axis)] &&
           grid.origin[axis] == layout.origin[axis] && grid.spacing[axis] == layout.spacing[axis];
}

LayerRange all_of(const Grid& layout, int axis) { return {0, layout.size[static_cast<std::size_t>(axis)]}; }

}  // namespace

LayerRange layers_for(const Grid& from, const Grid& layout, LayerRange wanted) {
    if (is_same(from, layout, 2) || wanted.count < 1) return wanted;
    std::size_t low = std::numeric_limits<std::size_t>::max(), high = 0;
    // All rows: an output that coincides with a sample needs no other row, but its neighbour does.
    for (int row = wanted.first; row < wanted.first + wanted.count; ++row)
        for (const std::size_t n : taps_of(from, layout, 2, row).index)
            low = std::min(low, n), high = std::max(high, n);
    return {static_cast<int>(low), static_cast<int>(high - low) + 1};
}

Grid resampled_layers(Grid grid, const Grid& from, const Grid& layout, LayerRange wanted, const RunJobs& run) {
    if (!is_same(from, layout, 2))
        grid = along(grid, layers_for(from, layout, wanted).first, from, layout, 2, wanted, run);
    for (const int axis : {1, 0})
        if (!is_same(from, layout, axis)) grid = along(grid, 0, from, layout, axis, all_of(layout, axis), run);
    return grid;
}

Grid resampled(Grid&& grid, const Grid& layout) {
    const Grid from{grid.size, grid.origin, grid.spacing, {}};
    return resampled_layers(std::move(grid), from, layout, all_of(layout, 2));
}

Grid resampled(const Grid& grid, const Grid& layout) {
    const Grid from{grid.size, grid.origin, grid.spacing, {}};
    for (const int axis : {2, 1, 0})
        if (!is_same(grid, layout, axis))
            return resampled(along(grid, 0, from, layout, axis, all_of(layout, axis), run_in_turn), layout);
    return grid;
}

}  // namespace tactus::volume
