// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus {

namespace {

// Runs of samples that are in or out, joined to those of the rows before them. Far fewer than samples.
struct Joined {
    std::vector<SampleRun> runs;
    std::vector<std::int32_t> parent;  // per run; the root is the first run of its part

    std::int32_t root(std::int32_t n) {
        while (parent[static_cast<std::size_t>(n)] != n) {
            std::int32_t& up = parent[static_cast<std::size_t>(n)];
            up = parent[static_cast<std::size_t>(up)];
            n = up;
        }
        return n;
    }

    void join(std::int32_t a, std::int32_t b) {
        a = root(a), b = root(b);
        if (a != b) parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }

    // Joins the runs [a, a_end) and [b, b_end) of two rows where they overlap, counting `reach` samples more.
    void join_rows(std::size_t a, std::size_t a_end, std::size_t b, std::size_t b_end, int reach) {
        while (a < a_end && b < b_end) {
            if (runs[a].begin < runs[b].end + reach && runs[b].begin < runs[a].end + reach)
                join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
            if (runs[a].end < runs[b].end) ++a;
            else ++b;
        }
    }

    template <typename Inside>
    Joined(const Grid& grid, bool faces_only, Inside inside) {
        const auto rows = static_cast<std::size_t>(grid.size[1]);
        std::vector<std::size_t> first(rows * static_cast<std::size_t>(grid.size[2]) + 1, 0);
        for (int k = 0; k < grid.size[2]; ++k)
            for (int j = 0; j < grid.size[1]; ++j) {
                const std::size_t row = static_cast<std::size_t>(k) * rows + static_cast<std::size_t>(j);
                const float* values = &grid.values[grid.index(0, j, k)];
                for (int i = 0; i < grid.size[0];) {
                    if (!inside(values[i])) {
                        ++i;
                        continue;
                    }
                    const int begin = i;
                    while (i < grid.size[0] && inside(values[i])) ++i;
                    parent.push_back(static_cast<std::int32_t>(runs.size()));
                    runs.push_back({begin, i, j, k, 0});
                }
                first[row + 1] = runs.size();
                const auto with = [&](std::size_t other) {
                    join_rows(first[other], first[other + 1], first[row], first[row + 1], faces_only ? 0 : 1);
                };
                if (j > 0) with(row - 1);
                if (k == 0) continue;
                with(row - rows);
                if (faces_only) continue;
                if (j > 0) with(row - rows - 1);
                if (j + 1 < grid.size[1]) with(row - rows + 1);
            }
    }
};

float below(float iso) { return std::nextafter(iso, -std::numeric_limits<float>::infinity()); }

}  // namespace

Components components_above(const Grid& grey, float iso) {
    Joined joined(grey, false, [iso](float value) { return value >= iso; });
    Components found;
    std::vector<std::int32_t> number(joined.runs.size(), -1);
    std::vector<std::size_t> sizes;
    std::vector<Components::Box> boxes;
    for (std::size_t n = 0; n < joined.runs.size(); ++n) {
        SampleRun& run = joined.runs[n];
        std::int32_t& id = number[static_cast<std::size_t>(joined.root(static_cast<std::int32_t>(n)))];
        if (id < 0) {
            id = static_cast<std::int32_t>(sizes.size());
            sizes.push_back(0);
            boxes.push_back({{run.begin, run.j, run.k}, {run.begin, run.j, run.k}});
        }
        run.part = id;
        sizes[static_cast<std::size_t>(id)] += static_cast<std::size_t>(run.end - run.begin);
        auto& [low, high] = boxes[static_cast<std::size_t>(id)];
        low = {std::min(low[0], run.begin), std::min(low[1], run.j), std::min(low[2], run.k)};
        high = {std::max(high[0], run.end - 1), std::max(high[1], run.j), std::max(high[2], run.k)};
    }
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    std::vector<std::int32_t> rank(sizes.size());
    for (std::size_t r = 0; r < order.size(); ++r) {
        rank[order[r]] = static_cast<std::int32_t>(r);
        found.voxels.push_back(sizes[order[r]]);
        found.boxes.push_back(boxes[order[r]]);
    }
    found.runs = std::move(joined.runs);
    for (SampleRun& run : found.runs) run.part = rank[static_cast<std::size_t>(run.part)];
    return found;
}

void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep) {
    for (const SampleRun& run : components.runs) {
        if (static_cast<std::size_t>(run.part) < keep) continue;
        float* row = &grey.values[grey.index(0, run.j, run.k)];
        for (int i = run.begin; i < run.end; ++i) row[i] = std::min(2.0f * iso - row[i], below(iso));
    }
}

std::size_t fill_hollows(Grid& grey, float iso) {
    Joined joined(grey, true, [iso](float value) { return !(value >= iso); });
    const auto& size = grey.size;
    std::vector<char> open(joined.runs.size(), 0);
    for (std::size_t n = 0; n < joined.runs.size(); ++n) {
        const SampleRun& run = joined.runs[n];
        if (run.begin == 0 || run.j == 0 || run.k == 0 || run.end == size[0] || run.j == size[1] - 1 ||
            run.k == size[2] - 1)
            open[static_cast<std::size_t>(joined.root(static_cast<std::int32_t>(n)))] = 1;
    }
    std::size_t filled = 0;
    for (std::size_t n = 0; n < joined.runs.size(); ++n) {
        if (open[static_cast<std::size_t>(joined.root(static_cast<std::int32_t>(n)))]) continue;
        const SampleRun& run = joined.runs[n];
        float* row = &grey.values[grey.index(0, run.j, run.k)];
        for (int i = run.begin; i < run.end; ++i) row[i] = 2.0f * iso - row[i];
        filled += static_cast<std::size_t>(run.end - run.begin);
    }
    return filled;
}

}  // namespace tactus
