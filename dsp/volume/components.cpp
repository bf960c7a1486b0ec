// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/components.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tactus::volume {

namespace {

// Union-find over runs; the root of a component is its first run.
struct Joined {
    const RunRows& rows;
    std::vector<std::int32_t> parent = std::vector<std::int32_t>(rows.runs.size());

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

    // Joins overlapping runs of two rows; `reach` samples extend the overlap.
    void join_rows(std::size_t one, std::size_t other, int reach) {
        std::size_t a = rows.start[one], b = rows.start[other];
        const std::size_t a_end = rows.start[one + 1], b_end = rows.start[other + 1];
        const auto& runs = rows.runs;
        while (a < a_end && b < b_end) {
            if (runs[a].begin < runs[b].end + reach && runs[b].begin < runs[a].end + reach)
                join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
            if (runs[a].end < runs[b].end) ++a;
            else ++b;
        }
    }

    Joined(const RunRows& all, bool faces_only) : rows(all) {
        std::iota(parent.begin(), parent.end(), std::int32_t{0});
        const auto width = static_cast<std::size_t>(rows.size[1]);
        for (int k = 0; k < rows.size[2]; ++k) {
            leave_if_stopped();
            for (int j = 0; j < rows.size[1]; ++j) {
                const std::size_t row = static_cast<std::size_t>(k) * width + static_cast<std::size_t>(j);
                const auto with = [&](std::size_t other) { join_rows(other, row, faces_only ? 0 : 1); };
                if (j > 0) with(row - 1);
                if (k == 0) continue;
                with(row - width);
                if (faces_only) continue;
                if (j > 0) with(row - width - 1);
                if (j + 1 < rows.size[1]) with(row - width + 1);
            }
        }
    }
};

float below(float iso) { return std::nextafter(iso, -std::numeric_limits<float>::infinity()); }

// visit(run, its samples in a row of values) for the runs of the layers in `grey`.
template <typename Visit>
void for_each_run(Grid& grey, const RunRows& rows, int first, Visit visit) {
    for (int k = 0; k < grey.size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < grey.size[1]; ++j) {
            float* row = &grey.values[grey.index(0, j, k)];
            for (const SampleRun& run : rows.row(j, first + k)) visit(run, std::span(row + run.begin, row + run.end));
        }
    }
}

// The complement of `components` in each row.
RunRows complement(const Components& components, std::size_t keep) {
    RunRows out{components.rows.size, {0}, {}};
    out.start.reserve(components.rows.start.size());
    for (int k = 0; k < out.size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < out.size[1]; ++j) {
            int begin = 0;
            for (const SampleRun& run : components.rows.row(j, k)) {
                if (keep > 0 && static_cast<std::size_t>(run.part) >= keep) continue;
                if (run.begin > begin) out.runs.push_back({begin, run.begin});
                begin = run.end;
            }
            if (begin < out.size[0]) out.runs.push_back({begin, out.size[0]});
            out.start.push_back(out.runs.size());
        }
    }
    return out;
}

}  // namespace

void append_above(RunRows& rows, const Grid& grey, float iso, int first, int count, const RunJobs& run) {
    const auto height = static_cast<std::size_t>(rows.size[1]);
    std::vector<RunRows> layers(static_cast<std::size_t>(count));
    run(count, [&](int n) {
        RunRows& layer = layers[static_cast<std::size_t>(n)];
        layer.start.reserve(height + 1);
        for (int j = 0; j < rows.size[1]; ++j) {
            const float* values = &grey.values[grey.index(0, j, first + n)];
            for (int i = 0; i < rows.size[0];) {
                if (!(values[i] >= iso)) {
                    ++i;
                    continue;
                }
                const int begin = i;
                while (i < rows.size[0] && values[i] >= iso) ++i;
                layer.runs.push_back({begin, i});
            }
            layer.start.push_back(layer.runs.size());
        }
    });
    for (RunRows& layer : layers) {
        const std::size_t before = rows.runs.size();
        for (std::size_t j = 1; j <= height; ++j) rows.start.push_back(before + layer.start[j]);
        rows.runs.insert(rows.runs.end(), layer.runs.begin(), layer.runs.end());
        layer = {};
    }
}

Components components_of(RunRows rows) {
    Components found;
    Joined joined(rows, false);
    std::vector<std::size_t> sizes;
    std::vector<Components::Box> boxes;
    for (int k = 0; k < rows.size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < rows.size[1]; ++j) {
            const std::size_t row =
                static_cast<std::size_t>(k) * static_cast<std::size_t>(rows.size[1]) + static_cast<std::size_t>(j);
            for (std::size_t n = rows.start[row]; n < rows.start[row + 1]; ++n) {
                SampleRun& run = rows.runs[n];
                const auto root = static_cast<std::size_t>(joined.root(static_cast<std::int32_t>(n)));
                if (root == n) {
                    run.part = static_cast<std::int32_t>(sizes.size());
                    sizes.push_back(0);
                    boxes.push_back({{run.begin, j, k}, {run.begin, j, k}});
                } else {
                    run.part = rows.runs[root].part;
                }
                const auto id = static_cast<std::size_t>(run.part);
                sizes[id] += static_cast<std::size_t>(run.end - run.begin);
                auto& [low, high] = boxes[id];
                low = {std::min(low[0], run.begin), std::min(low[1], j), std::min(low[2], k)};
                high = {std::max(high[0], run.end - 1), std::max(high[1], j), std::max(high[2], k)};
            }
        }
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
    found.rows = std::move(rows);
    for (SampleRun& run : found.rows.runs) run.part = rank[static_cast<std::size_t>(run.part)];
    return found;
}

Components components_above(const Grid& grey, float iso) {
    RunRows rows{grey.size, {0}, {}};
    append_above(rows, grey, iso, 0, grey.size[2]);
    return components_of(std::move(rows));
}

RunRows hollows_of(const Components& components, std::size_t keep) {
    RunRows outside = complement(components, keep);
    const auto& size = outside.size;
    std::vector<char> open(outside.runs.size(), 0);
    {
        Joined joined(outside, true);
        const auto root_of = [&](std::size_t n) {
            return static_cast<std::size_t>(joined.root(static_cast<std::int32_t>(n)));
        };
        std::size_t row = 0;
        for (int k = 0; k < size[2]; ++k) {
            leave_if_stopped();
            for (int j = 0; j < size[1]; ++j, ++row)
                for (std::size_t n = outside.start[row]; n < outside.start[row + 1]; ++n) {
                    const SampleRun& run = outside.runs[n];
                    if (run.begin == 0 || j == 0 || k == 0 || run.end == size[0] || j == size[1] - 1 ||
                        k == size[2] - 1)
                        open[root_of(n)] = 1;
                }
        }
        for (std::size_t n = 0; n < open.size(); ++n) open[n] = open[root_of(n)];
    }
    RunRows hollows{size, {0}, {}};
    hollows.start.reserve(outside.start.size());
    for (std::size_t row = 0; row + 1 < outside.start.size(); ++row) {
        for (std::size_t n = outside.start[row]; n < outside.start[row + 1]; ++n)
            if (!open[n]) hollows.runs.push_back(outside.runs[n]);
        hollows.start.push_back(hollows.runs.size());
    }
    return hollows;
}

void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep, int first) {
    for_each_run(grey, components.rows, first, [&](const SampleRun& run, std::span<float> values) {
        if (static_cast<std::size_t>(run.part) < keep) return;
        for (float& value : values) value = std::min(2.0f * iso - value, below(iso));
    });
}

void fill_hollows(Grid& grey, float iso, const RunRows& hollows, int first) {
    for_each_run(grey, hollows, first, [&](const SampleRun&, std::span<float> values) {
        for (float& value : values) value = 2.0f * iso - value;
    });
}

std::size_t fill_hollows(Grid& grey, float iso) {
    const RunRows hollows = hollows_of(components_above(grey, iso), 0);
    fill_hollows(grey, iso, hollows);
    std::size_t filled = 0;
    for (const SampleRun& run : hollows.runs) filled += static_cast<std::size_t>(run.end - run.begin);
    return filled;
}

}  // namespace tactus::volume
