// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus {

namespace {

using Axes = std::array<int, 3>;

// Which file axis runs along x, y and z of LPS; -1 where none does.
Axes axes_of(const SampleMap<Frame::lps>& map) {
    Axes file_axis{-1, -1, -1};
    for (int from = 0; from < 3; ++from) {
        const Vec3 direction = glm::abs(glm::normalize(map.step[from]));
        for (int axis = 0; axis < 3; ++axis)
            if (direction[axis] > 0.999998) file_axis[static_cast<std::size_t>(axis)] = from;  // 0.1 degrees
    }
    return file_axis;
}

bool is_complete(const Axes& axes) { return axes[0] >= 0 && axes[1] >= 0 && axes[2] >= 0; }

// Turns axes about without a second volume.
void mirror(std::vector<float>& values, const std::array<int, 3>& size, const std::array<bool, 3>& along) {
    const auto width = static_cast<std::size_t>(size[0]), rows = static_cast<std::size_t>(size[1]);
    const auto layers = static_cast<std::size_t>(size[2]), layer = width * rows;
    const auto row_at = [&](std::size_t j, std::size_t k) {
        return values.begin() + static_cast<std::ptrdiff_t>(k * layer + j * width);
    };
    const auto length = [](std::size_t n) { return static_cast<std::ptrdiff_t>(n); };
    for (std::size_t k = 0; k < layers; ++k) {
        for (std::size_t j = 0; along[0] && j < rows; ++j) std::reverse(row_at(j, k), row_at(j, k) + length(width));
        for (std::size_t j = 0; along[1] && j < rows / 2; ++j)
            std::swap_ranges(row_at(j, k), row_at(j, k) + length(width), row_at(rows - 1 - j, k));
    }
    for (std::size_t k = 0; along[2] && k < layers / 2; ++k)
        std::swap_ranges(row_at(0, k), row_at(0, k) + length(layer), row_at(0, layers - 1 - k));
}

Grid sorted(ScanVolume volume, const Axes& file_axis) {
    Grid out;
    out.origin = volume.map.origin;
    const std::array<std::ptrdiff_t, 3> stride{1, volume.size[0],
                                               static_cast<std::ptrdiff_t>(volume.size[0]) * volume.size[1]};
    std::array<std::ptrdiff_t, 3> step{};  // in the file, per step of an output axis
    std::ptrdiff_t start = 0;
    bool same = true;  // but for the direction
    std::array<bool, 3> mirrored{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis), from = static_cast<std::size_t>(file_axis[a]);
        const double along = volume.map.step[file_axis[a]][axis];
        out.size[a] = volume.size[from];
        out.spacing[axis] = glm::length(volume.map.step[file_axis[a]]);
        step[a] = along > 0.0 ? stride[from] : -stride[from];
        same = same && from == a;
        mirrored[a] = along < 0.0;
        if (along < 0.0) {
            start += stride[from] * (out.size[a] - 1);
            out.origin[axis] += along * (out.size[a] - 1);
        }
    }
    if (same) {
        out.values = std::move(volume.values);
        mirror(out.values, out.size, mirrored);
        return out;
    }
    out.values.resize(out.count());
    std::size_t n = 0;
    for (int k = 0; k < out.size[2]; ++k)
        for (int j = 0; j < out.size[1]; ++j) {
            const float* from = volume.values.data() + start + k * step[2] + j * step[1];
            for (int i = 0; i < out.size[0]; ++i) out.values[n++] = from[i * step[0]];
        }
    return out;
}

// Catmull-Rom weights of the samples base - 1 .. base + 2 at the fraction t.
std::array<double, 4> cubic(double t) {
    return {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0, ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t};
}

// The spacing of the file axis that runs most along each axis of LPS; the smallest where one would count twice.
Vec3 spacing_for(const ScanVolume& in) {
    const Vec3 steps = in.spacing();
    std::array<bool, 3> used{};
    Vec3 spacing(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        int best = 0;
        for (int from = 1; from < 3; ++from)
            if (std::abs(in.map.step[from][axis]) / steps[from] > std::abs(in.map.step[best][axis]) / steps[best])
                best = from;
        if (used[static_cast<std::size_t>(best)]) return Vec3(std::min({steps.x, steps.y, steps.z}));
        used[static_cast<std::size_t>(best)] = true;
        spacing[axis] = steps[best];
    }
    return spacing;
}

// The box of LPS axes around a turned volume.
Grid box_around(const ScanVolume& in) {
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner =
            in.map(Vec3(c & 1 ? in.size[0] - 1 : 0, c & 2 ? in.size[1] - 1 : 0, c & 4 ? in.size[2] - 1 : 0));
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    Grid out{{}, low, spacing_for(in), {}};
    double count = 1.0;
    for (int axis = 0; axis < 3; ++axis) count *= std::floor((high[axis] - low[axis]) / out.spacing[axis]) + 1.0;
    if (!(count <= 3e8))
        throw Error("the turned volume would need more than 300 million voxels on LPS axes; crop the file first");
    for (int axis = 0; axis < 3; ++axis)
        out.size[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / out.spacing[axis]) + 1;
    return out;
}

double sample(const ScanVolume& in, const Vec3& u, double outside) {
    std::array<int, 3> base{};
    std::array<std::array<double, 4>, 3> weight{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (!(u[axis] >= -0.5 && u[axis] <= in.size[a] - 0.5)) return outside;
        base[a] = static_cast<int>(std::floor(u[axis]));
        weight[a] = cubic(u[axis] - base[a]);
    }
    const auto clamped = [&in, &base](std::size_t a, int n) {
        return static_cast<std::size_t>(std::clamp(base[a] - 1 + n, 0, in.size[a] - 1));
    };
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            const float* row = &in.values[(clamped(2, k) * static_cast<std::size_t>(in.size[1]) + clamped(1, j)) *
                                          static_cast<std::size_t>(in.size[0])];
            double along = 0.0;
            for (int i = 0; i < 4; ++i) along += weight[0][static_cast<std::size_t>(i)] * double(row[clamped(0, i)]);
            sum += weight[1][static_cast<std::size_t>(j)] * weight[2][static_cast<std::size_t>(k)] * along;
        }
    return sum;
}

double nearest(const ScanVolume& in, const Vec3& u, double outside) {
    std::size_t at = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double n = std::floor(u[axis] + 0.5);
        if (!(n >= 0.0 && n <= in.size[a] - 1.0)) return outside;
        at = at * static_cast<std::size_t>(in.size[a]) + static_cast<std::size_t>(n);
    }
    return double(in.values[at]);
}

Grid turned(const ScanVolume& in) {
    Grid out = box_around(in);
    const Mat3 back = glm::inverse(in.map.step);
    const bool labels = in.kind == VolumeKind::labels;
    const double outside = labels ? 0.0 : double(*std::min_element(in.values.begin(), in.values.end()));
    out.values.resize(out.count());
    std::size_t n = 0;
    for (int k = 0; k < out.size[2]; ++k)
        for (int j = 0; j < out.size[1]; ++j)
            for (int i = 0; i < out.size[0]; ++i) {
                const Vec3 u = back * (out.position(i, j, k) - in.map.origin);
                out.values[n++] = static_cast<float>(labels ? nearest(in, u, outside) : sample(in, u, outside));
            }
    return out;
}

}  // namespace

bool is_turned(const ScanVolume& volume) { return !is_complete(axes_of(volume.map)); }

Grid lps_grid(ScanVolume volume) {
    const Axes axes = axes_of(volume.map);
    return is_complete(axes) ? sorted(std::move(volume), axes) : turned(volume);
}

}  // namespace tactus
