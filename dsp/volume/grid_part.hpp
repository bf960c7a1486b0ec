// SPDX-License-Identifier: Apache-2.0
// Extraction of a part of a grid.
#pragma once

#include "dsp/volume/grid.hpp"

#include <algorithm>
#include <array>

namespace tactus::volume {

/// Returns all layers, restricted along x and y to the samples from `low` to `high` (inclusive).
inline Grid window_of(const Grid& grid, const std::array<int, 2>& low, const std::array<int, 2>& high) {
    Grid out{
        {high[0] - low[0] + 1, high[1] - low[1] + 1, grid.size[2]}, grid.position(low[0], low[1], 0), grid.spacing, {}};
    out.values.resize(out.count());
    for (int k = 0; k < out.size[2]; ++k)
        for (int j = 0; j < out.size[1]; ++j)
            std::copy_n(&grid.values[grid.index(low[0], low[1] + j, k)], out.size[0], &out.values[out.index(0, j, k)]);
    return out;
}

}  // namespace tactus::volume
