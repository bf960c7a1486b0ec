// SPDX-License-Identifier: Apache-2.0
// The contact law of the points, and the sums over them.
// Part of pointshell_kernel.cpp; compiled once per instruction set.
#if defined(TACTUS_POINTSHELL_KERNEL_SUMS) == defined(HWY_TARGET_TOGGLE)
#ifdef TACTUS_POINTSHELL_KERNEL_SUMS
#undef TACTUS_POINTSHELL_KERNEL_SUMS
#else
#define TACTUS_POINTSHELL_KERNEL_SUMS
#endif

#include "dsp/contact/pointshell_kernel_field-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tactus::contact::kernel::HWY_NAMESPACE {

/// Points with a force, row by row: energy, force, stiffness, direction and moment.
struct Pushes {
    std::size_t rows = 0;
    alignas(64) float energy[batch], force[batch], stiffness[batch];
    alignas(64) float nx[batch], ny[batch], nz[batch], mx[batch], my[batch], mz[batch];
};

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

/// Writes the contributions of the points at l to the current row. Returns true if any of them has a force.
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
        nx = dot(pair.rotation, x, y, z);
        ny = dot(pair.rotation + 3, x, y, z);
        nz = dot(pair.rotation + 6, x, y, z);
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

}  // namespace tactus::contact::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
