// SPDX-License-Identifier: Apache-2.0
// Values side by side in one machine register: several segments are transformed at once, with the same bits as alone.
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

/// 16 bytes: what every x86-64 and every AArch64 has.
template <class T>
using Lanes = typename LaneType<T>::type;

template <class T>
inline constexpr std::size_t lane_count = sizeof(Lanes<T>) / sizeof(T);

}  // namespace tactus::signal
