// SPDX-License-Identifier: Apache-2.0
// SIMD vectors: several segments are transformed at once, with the same bits as one by one.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace tactus::signal {

template <class T>
struct LaneType;
template <>
struct LaneType<double> {
    using type = double __attribute__((vector_size(32)));
};
template <>
struct LaneType<float> {
    using type = float __attribute__((vector_size(32)));
};

/// 32 bytes: a register of AVX2, two of other machines.
template <class T>
using Lanes = typename LaneType<T>::type;

template <class T>
inline constexpr std::size_t lane_count = sizeof(Lanes<T>) / sizeof(T);

/// Cache lines: what is compiled for AVX2 requires lanes at multiples of 32 bytes, the compiler elsewhere only of 16.
template <class V>
struct LineAllocator {
    using value_type = V;
    LineAllocator() = default;
    template <class Other>
    LineAllocator(const LineAllocator<Other>&) noexcept {}
    V* allocate(std::size_t count) { return static_cast<V*>(::operator new(count * sizeof(V), std::align_val_t{64})); }
    void deallocate(V* memory, std::size_t) noexcept { ::operator delete(memory, std::align_val_t{64}); }
    friend bool operator==(LineAllocator, LineAllocator) { return true; }
};

template <class V>
using LineVector = std::vector<V, LineAllocator<V>>;

}  // namespace tactus::signal
