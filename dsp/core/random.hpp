// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: the value depends on seed and index only, so any partition of a run into blocks, and
// any skipped tick, leaves the others unchanged.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus {

/// Mixes 64 bits thoroughly (SplitMix64 finaliser; Steele, Lea and Flood 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// A stream of random numbers addressed by index.
struct Random {
    std::uint64_t seed = 0;

    std::uint64_t bits(std::uint64_t index) const { return mix(mix(seed) ^ index); }
    /// Uniform in [0, 1).
    double uniform(std::uint64_t index) const { return static_cast<double>(bits(index) >> 11) * 0x1.0p-53; }
    /// Standard normal (Box and Muller); uses one index.
    double normal(std::uint64_t index) const {
        const std::uint64_t a = bits(index), b = mix(a);
        const double radius = std::sqrt(-2.0 * std::log((static_cast<double>(a >> 11) + 0.5) * 0x1.0p-53));
        return radius * std::cos(2.0 * std::numbers::pi * static_cast<double>(b >> 11) * 0x1.0p-53);
    }
};

}  // namespace tactus
