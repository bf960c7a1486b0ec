// SPDX-License-Identifier: Apache-2.0
// 2 MB pages for large arrays with random access: fewer misses of the address-translation cache (TLB).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tactus {

/// Requests large pages for memory that was reserved but not yet written: its content is lost. Only a hint. Makes a
/// system call.
inline void prefer_large_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(data), first = (begin + page - 1) & ~(page - 1),
               end = (begin + bytes) & ~(page - 1);
    if (first >= end) return;
    // Used memory keeps its small pages; released, it comes back with large ones.
    madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
    madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Returns `count` copies of a value in large pages.
template <class T>
std::vector<T> large_vector(std::size_t count, const T& value) {
    std::vector<T> made;
    made.reserve(count);
    prefer_large_pages(made.data(), made.capacity() * sizeof(T));
    made.assign(count, value);
    return made;
}

}  // namespace tactus
