// SPDX-License-Identifier: Apache-2.0
// Sine waves with vectorisable loops.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus::signal {

/// Sine of a phase in 2^-32 cycles, within 1e-7 of the true one: x (1 - x²) P(x²) with x in half cycles, P interpolated at
/// six Chebyshev nodes.
inline float fast_sine(std::int32_t phase) noexcept {
    const float x = static_cast<float>(phase) * 0x1.0p-31f, u = x * x;
    const float p =
        3.1415926443f +
        u * (-2.0261194600f + u * (0.5240361177f + u * (-0.0751871692f + u * (0.0068600798f + u * -0.0003858948f))));
    return x * (1.0f - u) * p;
}

/// Phase of an oscillator as an integer: it does not drift, and does not depend on the partition into blocks.
struct WavePhase {
    std::uint64_t phase = 0;  ///< 2^64 is one cycle

    /// `cycles` per sample, from 0 to below 1.
    static std::uint64_t step(double cycles) noexcept {
        return static_cast<std::uint64_t>(std::clamp(cycles, 0.0, 0.999999) * 0x1.0p64);
    }
};

}  // namespace tactus::signal
