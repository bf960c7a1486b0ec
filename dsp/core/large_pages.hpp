// SPDX-License-Identifier: Apache-2.0
// Large arrays that are read here and there: with pages of 2 MB the processor finds its way in them at once.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tactus {

/// Asks for large pages under what has been reserved but not yet written: what it holds is lost. Only a hint; asks the
/// system.
inline void prefer_large_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(data), first = (begin + page - 1) & ~(page - 1),
               end = (begin + bytes) & ~(page - 1);
    if (first >= end) return;
    // Memory that was used before keeps its small pages; given back, it comes anew.
    madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
    madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

}  // namespace tactus
