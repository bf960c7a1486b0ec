// SPDX-License-Identifier: Apache-2.0
// Positions of a chunk's points in a voxmap and the interpolated field there, 16 lanes at a time.
// Part of pointshell_kernel.cpp; compiled once per instruction set.
#if defined(TACTUS_POINTSHELL_KERNEL_FIELD) == defined(HWY_TARGET_TOGGLE)
#ifdef TACTUS_POINTSHELL_KERNEL_FIELD
#undef TACTUS_POINTSHELL_KERNEL_FIELD
#else
#define TACTUS_POINTSHELL_KERNEL_FIELD
#endif

#include "dsp/contact/pointshell_kernel.hpp"

#include <algorithm>
#include <cstring>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tactus::contact::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, lanes>;
using V = hn::Vec<D>;
constexpr D d;

constexpr std::size_t points = chunk_points, batch = 4 * points;

struct Field {
    V value, x, y, z;  // m; gradient per cell
};

/// Positions of a chunk's points, in cells from the chunk's cell.
struct Places {
    alignas(64) float x[points], y[points], z[points];  // position
    alignas(64) float fx[points], fy[points], fz[points];  // within the point's own cell
    alignas(64) float weight[points];
    alignas(64) std::int32_t i[points], j[points], k[points];  // the cell, or the nearest sample
    alignas(64) std::int32_t index[points];  // from the chunk's base
};

HWY_INLINE V load(const float* from) { return hn::Load(d, from); }

HWY_INLINE V dot(const float* row, V x, V y, V z) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                   hn::Mul(hn::Set(d, row[2]), z));
}

HWY_INLINE V mix(V a, V b, V t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), t)); }

/// Cell along one axis. At the border, neighbours outside get weight 0 and a valid index.
template <bool border, bool nearest>
HWY_INLINE V corner(V p, int cell, int size, V& weight) {
    const V shift = hn::Set(d, nearest ? 0.5f : 0.0f);
    if constexpr (!border) return hn::Floor(hn::Add(p, shift));
    const auto low = static_cast<float>(-cell), high = static_cast<float>(size - 1 - cell);
    weight = hn::IfThenElseZero(hn::And(hn::Ge(p, hn::Set(d, low)), hn::Le(p, hn::Set(d, high))), weight);
    const V held = hn::Min(hn::Max(hn::Add(p, shift), hn::Set(d, low)), hn::Set(d, nearest ? high : high - 1.0f));
    return hn::Floor(held);
}

template <bool border, bool nearest>
HWY_INLINE void locate(const PairFrame& pair, const ChunkFrame& at, Places& places) {
    const hn::RebindToSigned<D> di;
    const ShellChunk& chunk = *at.chunk;
    const float* weights = pair.by_area ? chunk.area : chunk.count;
    const auto row = hn::Set(di, static_cast<std::int32_t>(pair.row));
    const auto plane = hn::Set(di, static_cast<std::int32_t>(pair.plane));
    for (std::size_t l = 0; l < at.rows * lanes; l += hn::Lanes(d)) {
        const V x = load(chunk.x + l), y = load(chunk.y + l), z = load(chunk.z + l);
        const V px = hn::Add(dot(pair.cells, x, y, z), hn::Set(d, at.fraction[0]));
        const V py = hn::Add(dot(pair.cells + 3, x, y, z), hn::Set(d, at.fraction[1]));
        const V pz = hn::Add(dot(pair.cells + 6, x, y, z), hn::Set(d, at.fraction[2]));
        V weight = load(weights + l);
        const V cx = corner<border, nearest>(px, at.cell[0], pair.size[0], weight);
        const V cy = corner<border, nearest>(py, at.cell[1], pair.size[1], weight);
        const V cz = corner<border, nearest>(pz, at.cell[2], pair.size[2], weight);
        hn::Store(px, d, places.x + l);
        hn::Store(py, d, places.y + l);
        hn::Store(pz, d, places.z + l);
        hn::Store(hn::Sub(px, cx), d, places.fx + l);
        hn::Store(hn::Sub(py, cy), d, places.fy + l);
        hn::Store(hn::Sub(pz, cz), d, places.fz + l);
        hn::Store(hn::Mul(weight, hn::Set(d, pair.stiffness)), d, places.weight + l);
        const auto i = hn::ConvertTo(di, cx), j = hn::ConvertTo(di, cy), k = hn::ConvertTo(di, cz);
        if constexpr (nearest) {
            hn::Store(i, di, places.i + l);
            hn::Store(j, di, places.j + l);
            hn::Store(k, di, places.k + l);
        }
        hn::Store(hn::Add(hn::Add(i, hn::Mul(j, row)), hn::Mul(k, plane)), di, places.index + l);
    }
}

/// The two samples along x at four corners of each point's cell, point by point.
struct Corners {
    alignas(64) float low[2 * points], y[2 * points], z[2 * points], yz[2 * points];
};

/// Copies eight bytes (two neighbouring samples) from each of two addresses.
HWY_INLINE void copy_pairs(const float* a, const float* b, float* to) {
#if HWY_TARGET == HWY_SCALAR
    std::memcpy(to, a, 8);
    std::memcpy(to + 2, b, 8);
#else
    const hn::FixedTag<float, 2> two;
    const hn::FixedTag<float, 4> four;
    hn::StoreU(hn::Combine(four, hn::LoadU(two, b), hn::LoadU(two, a)), four, to);
#endif
}

HWY_INLINE void fetch(const PairFrame& pair, const ChunkFrame& at, const Places& places, Corners& corners) {
    const float* base = pair.values + at.base;
    const std::ptrdiff_t y = pair.row, z = pair.plane, yz = pair.row + pair.plane;
    for (std::size_t l = 0; l < at.rows * lanes; l += 2) {
        const float *a = base + places.index[l], *b = base + places.index[l + 1];
        copy_pairs(a, b, corners.low + 2 * l);
        copy_pairs(a + y, b + y, corners.y + 2 * l);
        copy_pairs(a + z, b + z, corners.z + 2 * l);
        copy_pairs(a + yz, b + yz, corners.yz + 2 * l);
    }
}

/// Prefetches the samples that `fetch` will read into the nearest cache.
HWY_INLINE void prefetch(const PairFrame& pair, const ChunkFrame& at, const Places& places) {
    const float* base = pair.values + at.base;
    for (std::size_t l = 0; l < at.rows * lanes; ++l) {
        const float* sample = base + places.index[l];
        hwy::Prefetch(sample);
        hwy::Prefetch(sample + pair.row);
        hwy::Prefetch(sample + pair.plane);
        hwy::Prefetch(sample + pair.plane + pair.row);
    }
}

HWY_INLINE Field trilinear(const Corners& corners, const Places& places, std::size_t l) {
    V c000, c100, c010, c110, c001, c101, c011, c111;
    hn::LoadInterleaved2(d, corners.low + 2 * l, c000, c100);
    hn::LoadInterleaved2(d, corners.y + 2 * l, c010, c110);
    hn::LoadInterleaved2(d, corners.z + 2 * l, c001, c101);
    hn::LoadInterleaved2(d, corners.yz + 2 * l, c011, c111);
    const V fx = load(places.fx + l), fy = load(places.fy + l), fz = load(places.fz + l);
    const V d00 = hn::Sub(c100, c000), d10 = hn::Sub(c110, c010), d01 = hn::Sub(c101, c001), d11 = hn::Sub(c111, c011);
    const V x00 = hn::Add(c000, hn::Mul(d00, fx)), x10 = hn::Add(c010, hn::Mul(d10, fx));
    const V x01 = hn::Add(c001, hn::Mul(d01, fx)), x11 = hn::Add(c011, hn::Mul(d11, fx));
    const V e0 = hn::Sub(x10, x00), e1 = hn::Sub(x11, x01);
    const V y0 = hn::Add(x00, hn::Mul(e0, fy)), y1 = hn::Add(x01, hn::Mul(e1, fy));
    const V slope = hn::Sub(y1, y0);
    return {hn::Add(y0, hn::Mul(slope, fz)), mix(mix(d00, d10, fy), mix(d01, d11, fy), fz), mix(e0, e1, fz), slope};
}

/// The 27 samples around each point of a row of 16.
struct Taps {
    alignas(64) float value[27][lanes];
};

HWY_INLINE void fetch_taps(const PairFrame& pair, const ChunkFrame& at, const Places& places, std::size_t first,
                           Taps& taps) {
    for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t p = first + l;
        std::ptrdiff_t offset[3][3];
        const std::ptrdiff_t step[3] = {1, pair.row, pair.plane};
        const std::int32_t cell[3] = {places.i[p], places.j[p], places.k[p]};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int n = 0; n < 3; ++n) {
                int index = cell[axis] + n - 1;
                if (at.border) index = std::clamp(index, -at.cell[axis], pair.size[axis] - 1 - at.cell[axis]);
                offset[axis][n] = index * step[axis];
            }
        const float* base = pair.values + at.base;
        std::size_t tap = 0;
        for (const std::ptrdiff_t z : offset[2])
            for (const std::ptrdiff_t y : offset[1])
                for (const std::ptrdiff_t x : offset[0]) taps.value[tap++][l] = base[x + y + z];
    }
}

/// Weights of the quadratic B-spline and their derivatives at t from the nearest sample.
struct Spline {
    V weight[3], slope[3];

    explicit HWY_INLINE Spline(V t) {
        const V half = hn::Set(d, 0.5f), low = hn::Sub(half, t), high = hn::Add(half, t);
        weight[0] = hn::Mul(half, hn::Mul(low, low));
        weight[1] = hn::Sub(hn::Set(d, 0.75f), hn::Mul(t, t));
        weight[2] = hn::Mul(half, hn::Mul(high, high));
        slope[0] = hn::Sub(t, half);
        slope[1] = hn::Mul(hn::Set(d, -2.0f), t);
        slope[2] = high;
    }
};

HWY_INLINE V sum3(const V* weight, V a, V b, V c) {
    return hn::Add(hn::Add(hn::Mul(weight[0], a), hn::Mul(weight[1], b)), hn::Mul(weight[2], c));
}

HWY_INLINE Field quadratic(const Taps& taps, const Places& places, std::size_t l, std::size_t lane) {
    const Spline sx(load(places.fx + l)), sy(load(places.fy + l)), sz(load(places.fz + l));
    V value[3], along_x[3], along_y[3];
    for (std::size_t k = 0; k < 3; ++k) {
        V row[3], change[3];
        for (std::size_t j = 0; j < 3; ++j) {
            const auto* t = &taps.value[9 * k + 3 * j];
            const V a = load(t[0] + lane), b = load(t[1] + lane), c = load(t[2] + lane);
            row[j] = sum3(sx.weight, a, b, c);
            change[j] = sum3(sx.slope, a, b, c);
        }
        value[k] = sum3(sy.weight, row[0], row[1], row[2]);
        along_y[k] = sum3(sy.slope, row[0], row[1], row[2]);
        along_x[k] = sum3(sy.weight, change[0], change[1], change[2]);
    }
    return {sum3(sz.weight, value[0], value[1], value[2]), sum3(sz.weight, along_x[0], along_x[1], along_x[2]),
            sum3(sz.weight, along_y[0], along_y[1], along_y[2]), sum3(sz.slope, value[0], value[1], value[2])};
}

}  // namespace tactus::contact::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
