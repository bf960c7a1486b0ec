// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/iso_distance.hpp"

#include <algorithm>
#include <vector>

namespace tactus::volume {

namespace {

// Applies the weights over three rows in place; `before` is the original previous row, and receives the original row.
void smooth_row(float* row, const float* after, std::vector<float>& before) {
    for (std::size_t i = 0; i < before.size(); ++i) {
        const float here = row[i];
        row[i] = (before[i] + 4.0f * here + (after ? after[i] : here)) / 6.0f;
        before[i] = here;
    }
}

// Along x and y.
void smooth_layer(Grid& grid, int k) {
    const int width = grid.size[0], rows = grid.size[1];
    for (int j = 0; j < rows; ++j) {
        float* row = &grid.values[grid.index(0, j, k)];
        float before = row[0];
        for (int i = 0; i < width; ++i) {
            const float here = row[i];
            row[i] = (before + 4.0f * here + row[std::min(i + 1, width - 1)]) / 6.0f;
            before = here;
        }
    }
    float* row = &grid.values[grid.index(0, 0, k)];
    std::vector<float> before(row, row + width);
    for (int j = 0; j < rows; ++j, row += width) smooth_row(row, j + 1 < rows ? row + width : nullptr, before);
}

// Along z.
void smooth_wall(Grid& grid, int j) {
    const float* first = &grid.values[grid.index(0, j, 0)];
    std::vector<float> before(first, first + grid.size[0]);
    for (int k = 0; k < grid.size[2]; ++k)
        smooth_row(&grid.values[grid.index(0, j, k)],
                   k + 1 < grid.size[2] ? &grid.values[grid.index(0, j, k + 1)] : nullptr, before);
}

}  // namespace

Grid smoothed(Grid grid, const RunJobs& run) {
    if (grid.values.empty()) return grid;
    run(grid.size[2], [&](int k) { smooth_layer(grid, k); });
    run(grid.size[1], [&](int j) { smooth_wall(grid, j); });
    return grid;
}

}  // namespace tactus::volume
