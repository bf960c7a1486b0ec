// SPDX-License-Identifier: Apache-2.0
// Logical time. One flick is 1/705 600 000 s: the periods of 48 kHz, 44.1 kHz, 1 kHz, 150 Hz and 60 Hz are all whole
// numbers of flicks, so a schedule made of them never rounds.
#pragma once

#include <cstdint>

namespace tactus {

using Flicks = std::int64_t;

inline constexpr Flicks flicks_per_second = 705'600'000;

constexpr double seconds(Flicks t) { return static_cast<double>(t) / static_cast<double>(flicks_per_second); }
constexpr double rate_of(Flicks period) { return static_cast<double>(flicks_per_second) / static_cast<double>(period); }

/// Floor of a / b for b > 0, also for negative a (C++ division truncates towards zero).
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && a < 0); }
/// Ceiling of a / b for b > 0, also for negative a.
constexpr std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return -floor_div(-a, b); }

/// Nanoseconds of a logical time, rounded down, exact for any run length (128-bit product).
constexpr std::int64_t nanoseconds(Flicks t) {
    __extension__ using Wide = __int128;
    return static_cast<std::int64_t>(static_cast<Wide>(t) * 1'000'000'000 / flicks_per_second);
}

}  // namespace tactus
