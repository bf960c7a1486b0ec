// SPDX-License-Identifier: Apache-2.0
// SIMD vectors: several segments are transformed at once, with the same bits as one by one.
#pragma once

#include <cstddef>

namespace tactus::signal {

template <class T>
struct LaneType;
template <>
struct LaneType<double> {
    using type = double __attribute__((vector_size(16)));
};
template <>
struct LaneType<float> {
    using type = float __attribute__((vector_size(16)));
};

/// 16 bytes: available on every x86-64 and AArch64.
template <class T>
using Lanes = typename LaneType<T>::type;

template <class T>
inline constexpr std::size_t lane_count = sizeof(Lanes<T>) / sizeof(T);

}  // namespace tactus::signal
