// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::signal {

/// Sine whose phase is an integer in 2^-64 cycles: it does not drift, does not depend on the partition into blocks, and
/// is continuous when the frequency changes.
struct SineOscillator {
    double rate = 48000.0;  ///< samples per second
    std::uint64_t phase = 0;  ///< 2^64 is one cycle

    double operator()(double frequency) noexcept {
        const double y =
            std::sin(static_cast<double>(static_cast<std::int64_t>(phase)) * (std::numbers::pi * 0x1.0p-63));
        phase += increment(frequency / rate);
        return y;
    }

private:
    static std::uint64_t increment(double cycles) noexcept {
        // Removes whole cycles; NaN and infinity leave the phase unchanged.
        const double part = cycles - std::nearbyint(cycles);
        return part >= -0.5 && part < 0.5 ? static_cast<std::uint64_t>(static_cast<std::int64_t>(part * 0x1.0p64))
               : part == 0.5              ? std::uint64_t{1} << 63
                                          : 0;
    }
};

}  // namespace tactus::signal
