// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_kernel.hpp"

#include <algorithm>

// Highway compiles the rest of this file once per instruction set; the file includes itself for that.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dsp/contact/pointshell_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dsp/contact/pointshell_kernel_field-inl.hpp"
#include "dsp/contact/pointshell_kernel_sums-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tactus::contact::kernel::HWY_NAMESPACE {

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

void evaluate_chunks(const PairFrame& pair, const ChunkFrame* chunks, std::size_t count, LaneSums& into) {
    Places places[2];
    Corners corners;
    Pushes pushes;
    if (count > 0) locate_cells(pair, chunks[0], places[0]);
    for (std::size_t n = 0; n < count; ++n) {
        Places &here = places[n % 2], &next = places[(n + 1) % 2];
        if (n + 1 < count) {
            locate_cells(pair, chunks[n + 1], next);
            if (pair.prefetches) prefetch(pair, chunks[n + 1], next);
        }
        if (pair.quadratic) add_quadratic(pair, chunks[n], here, corners, pushes, into);
        else add_trilinear(pair, chunks[n], here, corners, pushes, into);
        if (pushes.rows + points / lanes <= batch / lanes && n + 1 < count) continue;
        add_up(pushes, into, pair.energy_only);
        pushes.rows = 0;
    }
}

}  // namespace tactus::contact::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tactus::contact::kernel {

HWY_EXPORT(evaluate_chunks);

namespace {

/// Compiled variants that can run here, best first (better ones have lower bits).
std::int64_t usable() { return HWY_TARGETS & (hwy::SupportedTargets() | HWY_STATIC_TARGET); }

std::int64_t forced = 0;

std::int64_t in_use() {
    const std::int64_t all = forced ? forced : usable();
    return all & -all;
}

}  // namespace

void evaluate(const PairFrame& pair, std::span<const ChunkFrame> chunks, LaneSums& into) noexcept {
    HWY_DYNAMIC_DISPATCH(evaluate_chunks)(pair, chunks.data(), std::min(chunks.size(), max_chunks), into);
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

}  // namespace tactus::contact::kernel
#endif
