// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/resample.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus {

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

Grid along(const Grid& in, const Grid& layout, int axis) {
    const auto a = static_cast<std::size_t>(axis);
    Grid out{in.size, in.origin, in.spacing, {}};
    out.size[a] = layout.size[a];
    out.origin[axis] = layout.origin[axis];
    out.spacing[axis] = layout.spacing[axis];
    out.values.assign(out.count(), 0.0f);
    // Seen from this axis, a grid is `outer` blocks of size[axis] rows of `stride` neighbouring values.
    std::size_t stride = 1, outer = 1;
    for (std::size_t n = 0; n < a; ++n) stride *= static_cast<std::size_t>(in.size[n]);
    for (std::size_t n = a + 1; n < 3; ++n) outer *= static_cast<std::size_t>(in.size[n]);
    const std::size_t from_rows = static_cast<std::size_t>(in.size[a]), to_rows = static_cast<std::size_t>(out.size[a]);
    const double width = std::max(1.0, out.spacing[axis] / in.spacing[axis]);
    for (std::size_t row = 0; row < to_rows; ++row) {
        const double u =
            (out.origin[axis] + static_cast<double>(row) * out.spacing[axis] - in.origin[axis]) / in.spacing[axis];
        const Taps taps = taps_at(u, width, in.size[a]);
        for (std::size_t block = 0; block < outer; ++block) {
            float* to = &out.values[(block * to_rows + row) * stride];
            for (std::size_t n = 0; n < taps.index.size(); ++n) {
                const float* from = &in.values[(block * from_rows + taps.index[n]) * stride];
                const float weight = taps.weight[n];
                for (std::size_t s = 0; s < stride; ++s) to[s] += weight * from[s];
            }
        }
    }
    return out;
}

// Nothing to interpolate along this axis, and nothing to leave out.
bool is_same(const Grid& grid, const Grid& layout, int axis) {
    return grid.size[static_cast<std::size_t>(axis)] == layout.size[static_cast<std::size_t>(axis)] &&
           grid.origin[axis] == layout.origin[axis] && grid.spacing[axis] == layout.spacing[axis];
}

}  // namespace

Grid resampled(Grid&& grid, const Grid& layout) {
    for (const int axis : {2, 1, 0})
        if (!is_same(grid, layout, axis)) grid = along(grid, layout, axis);
    return std::move(grid);
}

Grid resampled(const Grid& grid, const Grid& layout) {
    for (const int axis : {2, 1, 0})
        if (!is_same(grid, layout, axis)) return resampled(along(grid, layout, axis), layout);
    return grid;
}

}  // namespace tactus
