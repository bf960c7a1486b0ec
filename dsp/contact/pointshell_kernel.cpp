// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_kernel.hpp"

#include <algorithm>
#include <cstring>

// Highway compiles what follows once per instruction set; this file includes itself for it.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dsp/contact/pointshell_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tactus::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, lanes>;
using V = hn::Vec<D>;
constexpr D d;

constexpr std::size_t points = chunk_points, batch = 4 * points;

struct Field {
    V value, x, y, z;  // m; gradient per cell
};

/// Where the points of a chunk lie, in cells from the chunk's cell.
struct Places {
    alignas(64) float x[points], y[points], z[points];  // position
    alignas(64) float fx[points], fy[points], fz[points];  // within the point's own cell
    alignas(64) float weight[points];
    alignas(64) std::int32_t i[points], j[points], k[points];  // the cell, or the nearest sample
    alignas(64) std::int32_t index[points];  // from the chunk's base
};

/// Points that push, row by row: energy, force, stiffness, direction and moment.
struct Pushes {
    std::size_t rows = 0;
    alignas(64) float energy[batch], force[batch], stiffness[batch];
    alignas(64) float nx[batch], ny[batch], nz[batch], mx[batch], my[batch], mz[batch];
};

HWY_INLINE V load(const float* from) { return hn::Load(d, from); }

HWY_INLINE V dot(const float* row, V x, V y, V z) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                   hn::Mul(hn::Set(d, row[2]), z));
}

HWY_INLINE V mix(V a, V b, V t) { return hn::Add(a, hn::Mul(hn::Sub(b, a), t)); }

/// Cell along one axis. On the border what lies outside gets weight 0 and a cell that exists.
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

HWY_INLINE void fetch(const PairFrame& pair, const ChunkFrame& at, const Places& places, Corners& corners) {
    const float* base = pair.values + at.base;
    for (std::size_t l = 0; l < at.rows * lanes; ++l) {
        const float* sample = base + places.index[l];
        std::memcpy(corners.low + 2 * l, sample, 8);
        std::memcpy(corners.y + 2 * l, sample + pair.row, 8);
        std::memcpy(corners.z + 2 * l, sample + pair.plane, 8);
        std::memcpy(corners.yz + 2 * l, sample + pair.plane + pair.row, 8);
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

/// Weights of the quadratic B-spline and their slopes at t from the nearest sample.
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

struct Law {
    V energy, force, stiffness;
};

HWY_INLINE Law ramp(V x, float width, float inverse_width) {
    const V zero = hn::Zero(d), w = hn::Set(d, width), half = hn::Set(d, 0.5f);
    const V c = hn::Min(hn::Max(x, zero), w), e = hn::Max(hn::Sub(x, w), zero);
    const V share = hn::Mul(c, hn::Set(d, inverse_width)), ramped = hn::Mul(hn::Mul(half, c), share);
    return {hn::Add(hn::Mul(hn::Mul(ramped, c), hn::Set(d, 1.0f / 3.0f)), hn::Mul(e, hn::Mul(half, hn::Add(w, e)))),
            hn::Add(ramped, e), share};
}

/// Writes what the points at l do into the row of pushes being filled. True when any of them pushes.
HWY_INLINE bool respond(const PairFrame& pair, const ChunkFrame& at, const Places& places, const Field& field,
                        std::size_t l, std::size_t lane, Pushes& pushes, LaneSums& into) {
    const V weight = load(places.weight + l), depth = hn::Neg(field.value);
    Law law = ramp(hn::Add(depth, hn::Set(d, pair.law.start)), pair.law.width, pair.law.inverse_width);
    const auto pushing = hn::And(hn::Gt(law.force, hn::Zero(d)), hn::Gt(weight, hn::Zero(d)));
    const std::size_t slot = pushes.rows * lanes + lane;
    if (pair.saturates) {
        const Law off = ramp(hn::Sub(depth, hn::Set(d, pair.law.level)), pair.law.level_width, pair.law.level_inverse);
        law = {hn::Sub(law.energy, off.energy), hn::Sub(law.force, off.force), hn::Sub(law.stiffness, off.stiffness)};
    }
    const V deep = hn::IfThenElseZero(hn::Gt(weight, hn::Zero(d)), depth);
    hn::Store(hn::Max(load(into.deepest + lane), deep), d, into.deepest + lane);
    into.in_contact += hn::CountTrue(d, pushing);
    hn::Store(hn::Mul(weight, law.energy), d, pushes.energy + slot);
    const bool any = !hn::AllFalse(d, pushing);
    if (pair.energy_only) return any;
    hn::Store(hn::Mul(weight, law.force), d, pushes.force + slot);
    hn::Store(hn::Mul(weight, law.stiffness), d, pushes.stiffness + slot);
    V nx = hn::Mul(field.x, hn::Set(d, pair.per_spacing[0])), ny = hn::Mul(field.y, hn::Set(d, pair.per_spacing[1])),
      nz = hn::Mul(field.z, hn::Set(d, pair.per_spacing[2]));
    if (pair.by_normal) {
        const ShellChunk& c = *at.chunk;
        const V x = hn::Neg(load(c.nx + l)), y = hn::Neg(load(c.ny + l)), z = hn::Neg(load(c.nz + l));
        nx = dot(pair.turn, x, y, z);
        ny = dot(pair.turn + 3, x, y, z);
        nz = dot(pair.turn + 6, x, y, z);
    }
    const auto lever = [&](const float* place, std::size_t axis) HWY_ATTR {
        return hn::Add(hn::Mul(load(place + l), hn::Set(d, pair.spacing[axis])), hn::Set(d, at.lever[axis]));
    };
    const V rx = lever(places.x, 0), ry = lever(places.y, 1), rz = lever(places.z, 2);
    hn::Store(nx, d, pushes.nx + slot);
    hn::Store(ny, d, pushes.ny + slot);
    hn::Store(nz, d, pushes.nz + slot);
    hn::Store(hn::Sub(hn::Mul(ry, nz), hn::Mul(rz, ny)), d, pushes.mx + slot);
    hn::Store(hn::Sub(hn::Mul(rz, nx), hn::Mul(rx, nz)), d, pushes.my + slot);
    hn::Store(hn::Sub(hn::Mul(rx, ny), hn::Mul(ry, nx)), d, pushes.mz + slot);
    return any;
}

HWY_INLINE void locate_cells(const PairFrame& pair, const ChunkFrame& at, Places& places) {
    if (at.border) locate<true, false>(pair, at, places);
    else locate<false, false>(pair, at, places);
}

HWY_INLINE void add_trilinear(const PairFrame& pair, const ChunkFrame& at, const Places& places, Corners& corners,
                              Pushes& pushes, LaneSums& into) {
    fetch(pair, at, places, corners);
    for (std::size_t row = 0; row < at.rows; ++row) {
        bool any = false;
        for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
            const std::size_t l = row * lanes + lane;
            any |= respond(pair, at, places, trilinear(corners, places, l), l, lane, pushes, into);
        }
        pushes.rows += any;
    }
}

HWY_INLINE void add_quadratic(const PairFrame& pair, const ChunkFrame& at, Places& places, Corners& corners,
                              Pushes& pushes, LaneSums& into) {
    fetch(pair, at, places, corners);
    bool near[points / lanes] = {};
    for (std::size_t row = 0; row < at.rows; ++row)
        for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
            const V value = trilinear(corners, places, row * lanes + lane).value;
            near[row] |= !hn::AllFalse(d, hn::Lt(value, hn::Set(d, pair.near)));
        }
    if (at.border) locate<true, true>(pair, at, places);
    else locate<false, true>(pair, at, places);
    Taps taps;
    for (std::size_t row = 0; row < at.rows; ++row) {
        if (!near[row]) continue;
        fetch_taps(pair, at, places, row * lanes, taps);
        bool any = false;
        for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
            const std::size_t l = row * lanes + lane;
            any |= respond(pair, at, places, quadratic(taps, places, l, lane), l, lane, pushes, into);
        }
        pushes.rows += any;
    }
}

/// Sums over the rows, in parts small enough for 16 registers.
HWY_INLINE void add_up(const Pushes& pushes, LaneSums& into, bool energy_only) {
    const std::size_t end = pushes.rows * lanes;
    for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
        const auto add = [&](std::size_t n, V sum)
                             HWY_ATTR { hn::Store(hn::Add(load(into.value[n] + lane), sum), d, into.value[n] + lane); };
        V energy = hn::Zero(d);
        for (std::size_t s = lane; s < end; s += lanes) energy = hn::Add(energy, load(pushes.energy + s));
        add(0, energy);
        if (energy_only) continue;
        V total = hn::Zero(d), gx = total, gy = total, gz = total, tx = total, ty = total, tz = total;
        for (std::size_t s = lane; s < end; s += lanes) {
            const V f = load(pushes.force + s);
            total = hn::Add(total, f);
            gx = hn::Add(gx, hn::Mul(f, load(pushes.nx + s)));
            gy = hn::Add(gy, hn::Mul(f, load(pushes.ny + s)));
            gz = hn::Add(gz, hn::Mul(f, load(pushes.nz + s)));
            tx = hn::Add(tx, hn::Mul(f, load(pushes.mx + s)));
            ty = hn::Add(ty, hn::Mul(f, load(pushes.my + s)));
            tz = hn::Add(tz, hn::Mul(f, load(pushes.mz + s)));
        }
        add(1, total), add(2, gx), add(3, gy), add(4, gz), add(5, tx), add(6, ty), add(7, tz);
        V xx = hn::Zero(d), xy = xx, xz = xx, yy = xx, yz = xx, zz = xx;
        V nm[9] = {xx, xx, xx, xx, xx, xx, xx, xx, xx};
        for (std::size_t s = lane; s < end; s += lanes) {
            const V c = load(pushes.stiffness + s);
            const V nx = load(pushes.nx + s), ny = load(pushes.ny + s), nz = load(pushes.nz + s);
            const V cx = hn::Mul(c, nx), cy = hn::Mul(c, ny), cz = hn::Mul(c, nz);
            xx = hn::Add(xx, hn::Mul(cx, nx));
            xy = hn::Add(xy, hn::Mul(cx, ny));
            xz = hn::Add(xz, hn::Mul(cx, nz));
            yy = hn::Add(yy, hn::Mul(cy, ny));
            yz = hn::Add(yz, hn::Mul(cy, nz));
            zz = hn::Add(zz, hn::Mul(cz, nz));
        }
        add(8, xx), add(9, xy), add(10, xz), add(11, yy), add(12, yz), add(13, zz);
        for (std::size_t s = lane; s < end; s += lanes) {
            const V c = load(pushes.stiffness + s);
            const V cx = hn::Mul(c, load(pushes.nx + s)), cy = hn::Mul(c, load(pushes.ny + s)),
                    cz = hn::Mul(c, load(pushes.nz + s));
            const V mx = load(pushes.mx + s), my = load(pushes.my + s), mz = load(pushes.mz + s);
            nm[0] = hn::Add(nm[0], hn::Mul(cx, mx));
            nm[1] = hn::Add(nm[1], hn::Mul(cx, my));
            nm[2] = hn::Add(nm[2], hn::Mul(cx, mz));
            nm[3] = hn::Add(nm[3], hn::Mul(cy, mx));
            nm[4] = hn::Add(nm[4], hn::Mul(cy, my));
            nm[5] = hn::Add(nm[5], hn::Mul(cy, mz));
            nm[6] = hn::Add(nm[6], hn::Mul(cz, mx));
            nm[7] = hn::Add(nm[7], hn::Mul(cz, my));
            nm[8] = hn::Add(nm[8], hn::Mul(cz, mz));
        }
        for (std::size_t n = 0; n < 9; ++n) add(14 + n, nm[n]);
        xx = xy = xz = yy = yz = zz = hn::Zero(d);
        for (std::size_t s = lane; s < end; s += lanes) {
            const V c = load(pushes.stiffness + s);
            const V mx = load(pushes.mx + s), my = load(pushes.my + s), mz = load(pushes.mz + s);
            const V cx = hn::Mul(c, mx), cy = hn::Mul(c, my), cz = hn::Mul(c, mz);
            xx = hn::Add(xx, hn::Mul(cx, mx));
            xy = hn::Add(xy, hn::Mul(cx, my));
            xz = hn::Add(xz, hn::Mul(cx, mz));
            yy = hn::Add(yy, hn::Mul(cy, my));
            yz = hn::Add(yz, hn::Mul(cy, mz));
            zz = hn::Add(zz, hn::Mul(cz, mz));
        }
        add(23, xx), add(24, xy), add(25, xz), add(26, yy), add(27, yz), add(28, zz);
    }
}

void evaluate_chunks(const PairFrame& pair, const ChunkFrame* chunks, std::size_t count, LaneSums& into) {
    Places places;
    Corners corners;
    Pushes pushes;
    for (std::size_t n = 0; n < count; ++n) {
        locate_cells(pair, chunks[n], places);
        if (pair.quadratic) add_quadratic(pair, chunks[n], places, corners, pushes, into);
        else add_trilinear(pair, chunks[n], places, corners, pushes, into);
        if (pushes.rows + points / lanes <= batch / lanes && n + 1 < count) continue;
        add_up(pushes, into, pair.energy_only);
        pushes.rows = 0;
    }
}

}  // namespace tactus::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tactus::kernel {

HWY_EXPORT(evaluate_chunks);

namespace {

/// What was compiled and can run here, better ones first (their bits are lower).
std::int64_t usable() { return HWY_TARGETS & (hwy::SupportedTargets() | HWY_STATIC_TARGET); }

std::int64_t forced = 0;

std::int64_t in_use() {
    const std::int64_t all = forced ? forced : usable();
    return all & -all;
}

}  // namespace

void evaluate(const PairFrame& pair, std::span<const ChunkFrame> chunks, LaneSums& into) noexcept {
    HWY_DYNAMIC_DISPATCH(evaluate_chunks)(pair, chunks.data(), std::min(chunks.size(), most_chunks), into);
}

std::vector<std::string_view> variants() {
    std::vector<std::string_view> names;
    for (std::int64_t left = usable(); left; left &= left - 1) names.emplace_back(hwy::TargetName(left & -left));
    return names;
}

std::string_view variant_in_use() { return hwy::TargetName(in_use()); }

bool use_variant(std::string_view name) {
    for (std::int64_t left = usable(); left; left &= left - 1) {
        const std::int64_t target = left & -left;
        if (!name.empty() && name != hwy::TargetName(target)) continue;
        forced = name.empty() ? 0 : target;
        hwy::GetChosenTarget().Update(forced ? forced : hwy::SupportedTargets());
        return true;
    }
    return false;
}

}  // namespace tactus::kernel
#endif
