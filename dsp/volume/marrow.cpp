// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/marrow.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::volume {

namespace {

using Runs = std::vector<SampleRun>;

/// Sorts runs and joins those that touch or overlap.
void tidy(Runs& runs) {
    std::sort(runs.begin(), runs.end(), [](const SampleRun& a, const SampleRun& b) { return a.begin < b.begin; });
    std::size_t count = 0;
    for (const SampleRun& run : runs) {
        if (count > 0 && run.begin <= runs[count - 1].end) runs[count - 1].end = std::max(runs[count - 1].end, run.end);
        else runs[count++] = run;
    }
    runs.resize(count);
}

/// A row at a time: make(j, k, runs) fills the runs of a row, in any order.
template <typename Make>
RunRows rows_from(const std::array<int, 3>& size, Make make) {
    RunRows out{size, {0}, {}};
    Runs row;
    for (int k = 0; k < size[2]; ++k) {
        leave_if_stopped();
        for (int j = 0; j < size[1]; ++j) {
            row.clear();
            make(j, k, row);
            tidy(row);
            out.runs.insert(out.runs.end(), row.begin(), row.end());
            out.start.push_back(out.runs.size());
        }
    }
    return out;
}

/// Samples within `radius` m of one of `rows`.
RunRows dilated(const RunRows& rows, double radius, const Vec3& spacing) {
    const int reach_y = static_cast<int>(radius / spacing.y), reach_z = static_cast<int>(radius / spacing.z);
    return rows_from(rows.size, [&](int j, int k, Runs& into) {
        for (int z = std::max(k - reach_z, 0); z <= std::min(k + reach_z, rows.size[2] - 1); ++z)
            for (int y = std::max(j - reach_y, 0); y <= std::min(j + reach_y, rows.size[1] - 1); ++y) {
                const double dy = (y - j) * spacing.y, dz = (z - k) * spacing.z;
                const double left = radius * radius - dy * dy - dz * dz;
                if (left < 0.0) continue;
                const int wide = static_cast<int>(std::sqrt(left) / spacing.x);
                for (const SampleRun& run : rows.row(y, z))
                    into.push_back({std::max(run.begin - wide, 0), std::min(run.end + wide, rows.size[0])});
            }
    });
}

RunRows without(const RunRows& rows, const RunRows& other) {
    return rows_from(rows.size, [&](int j, int k, Runs& into) {
        const std::span<const SampleRun> holes = other.row(j, k);
        for (const SampleRun& run : rows.row(j, k)) {
            int begin = run.begin;
            for (const SampleRun& hole : holes) {
                if (hole.end <= begin || hole.begin >= run.end) continue;
                if (hole.begin > begin) into.push_back({begin, hole.begin});
                begin = hole.end;
            }
            if (begin < run.end) into.push_back({begin, run.end});
        }
    });
}

/// The runs of those parts for which `keeps` is true.
template <typename Keeps>
RunRows parts_of(const RunRows& rows, Keeps keeps) {
    return rows_from(rows.size, [&](int j, int k, Runs& into) {
        for (const SampleRun& run : rows.row(j, k))
            if (keeps(static_cast<std::size_t>(run.part))) into.push_back(run);
    });
}

/// Per part, the number of its samples that are also in `other`.
std::vector<std::size_t> overlaps(const Components& parts, const RunRows& other) {
    std::vector<std::size_t> counts(parts.voxels.size(), 0);
    for (int k = 0; k < other.size[2]; ++k)
        for (int j = 0; j < other.size[1]; ++j)
            for (const SampleRun& run : parts.rows.row(j, k))
                for (const SampleRun& one : other.row(j, k))
                    if (const int both = std::min(run.end, one.end) - std::max(run.begin, one.begin); both > 0)
                        counts[static_cast<std::size_t>(run.part)] += static_cast<std::size_t>(both);
    return counts;
}

/// Whether a ball of that radius fits into a part: squared distances to samples outside of it, exact up to the radius, an
/// axis after the other (Saito and Toriwaki 1994). A box thinner than the ball needs none. Memory: 4 bytes for each sample
/// of the part's box.
bool holds_ball(const Components& parts, std::size_t part, double radius, const Vec3& spacing) {
    const Components::Box& box = parts.boxes[part];
    std::array<int, 3> size{};
    for (std::size_t a = 0; a < 3; ++a) {
        size[a] = box.last[a] - box.first[a] + 3;  // with a border of outside
        if (size[a] * spacing[static_cast<int>(a)] < 2.0 * radius) return false;
    }
    const auto wide = static_cast<std::size_t>(size[0]), high = static_cast<std::size_t>(size[1]);
    const auto at = [&](int i, int j, int k) {
        return (static_cast<std::size_t>(k) * high + static_cast<std::size_t>(j)) * wide + static_cast<std::size_t>(i);
    };
    const auto far = static_cast<float>(radius * radius);
    std::vector<float> square(wide * high * static_cast<std::size_t>(size[2]), 0.0f);
    // Along x exactly; then along y and z by the smallest sum within the radius.
    for (int k = 1; k + 1 < size[2]; ++k)
        for (int j = 1; j + 1 < size[1]; ++j)
            for (const SampleRun& run : parts.rows.row(j - 1 + box.first[1], k - 1 + box.first[2])) {
                if (static_cast<std::size_t>(run.part) != part) continue;
                for (int i = run.begin; i < run.end; ++i) {
                    const double d = spacing.x * std::min(i - run.begin + 1, run.end - i);
                    square[at(i - box.first[0] + 1, j, k)] = std::min(static_cast<float>(d * d), far);
                }
            }
    std::vector<float> line;
    for (const int axis : {1, 2}) {
        const int count = size[static_cast<std::size_t>(axis)], others = axis == 1 ? size[2] : size[1];
        const double h = spacing[axis];
        const int reach = static_cast<int>(radius / h) + 1;
        line.resize(static_cast<std::size_t>(count));
        for (int o = 0; o < others; ++o) {
            leave_if_stopped();
            for (int i = 0; i < size[0]; ++i) {
                const auto place = [&](int n) { return axis == 1 ? at(i, n, o) : at(i, o, n); };
                for (int n = 0; n < count; ++n) line[static_cast<std::size_t>(n)] = square[place(n)];
                for (int n = 0; n < count; ++n) {
                    float least = line[static_cast<std::size_t>(n)];
                    for (int d = 1; d <= reach; ++d) {
                        const auto added = static_cast<float>(d * h * d * h);
                        if (added >= least) break;
                        if (n - d >= 0) least = std::min(least, line[static_cast<std::size_t>(n - d)] + added);
                        if (n + d < count) least = std::min(least, line[static_cast<std::size_t>(n + d)] + added);
                    }
                    square[place(n)] = least;
                }
            }
        }
    }
    return *std::max_element(square.begin(), square.end()) >= far;
}

}  // namespace

RunRows united(const RunRows& a, const RunRows& b) {
    return rows_from(a.size, [&](int j, int k, Runs& into) {
        for (const RunRows* rows : {&a, &b})
            for (const SampleRun& run : rows->row(j, k)) into.push_back({run.begin, run.end});
    });
}

std::size_t count_of(const RunRows& rows) {
    std::size_t count = 0;
    for (const SampleRun& run : rows.runs) count += static_cast<std::size_t>(run.end - run.begin);
    return count;
}

RunRows marrow_of(const RunRows& solid, const RunRows& air, const Components::Box& inner, const Vec3& spacing,
                  const MarrowLimits& limits) {
    RunRows closed = dilated(solid, limits.closing, spacing);
    // Air outside of the scan stays air, however near.
    closed = rows_from(closed.size, [&](int j, int k, Runs& into) {
        if (j < inner.first[1] || j > inner.last[1] || k < inner.first[2] || k > inner.last[2]) return;
        for (SampleRun run : closed.row(j, k)) {
            run.begin = std::max(run.begin, inner.first[0]);
            run.end = std::min(run.end, inner.last[0] + 1);
            if (run.begin < run.end) into.push_back({run.begin, run.end});
        }
    });
    const Components cavities = components_of(hollows_of({std::move(closed), {}, {}}, 0));
    std::vector<char> is_marrow(cavities.voxels.size(), 0);
    for (std::size_t n = 0; n < is_marrow.size(); ++n)
        is_marrow[n] = !holds_ball(cavities, n, limits.half_width - limits.closing, spacing);
    const std::vector<std::size_t> with_air = overlaps(cavities, air);
    for (std::size_t n = 0; n < is_marrow.size(); ++n)
        if (static_cast<double>(with_air[n]) > limits.max_air * static_cast<double>(cavities.voxels[n]))
            is_marrow[n] = 0;
    const RunRows kept = parts_of(cavities.rows, [&](std::size_t part) { return is_marrow[part] != 0; });
    if (kept.runs.empty()) return kept;
    const RunRows filled = without(dilated(kept, limits.closing, spacing), solid);
    // A ball leaves the edges of a cavity out, which are closed hollows now.
    const RunRows edges = hollows_of({united(solid, filled), {}, {}}, 0);
    return united(filled, without(edges, without(edges, dilated(kept, 2.0 * limits.closing, spacing))));
}

}  // namespace tactus::volume
