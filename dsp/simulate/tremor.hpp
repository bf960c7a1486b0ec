// SPDX-License-Identifier: Apache-2.0
// Physiological tremor of a hand.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/core/types.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::simulate {

/// Noise band-limited to 8–12 Hz: eight tones per axis with random phases, one at a random frequency in each 0.5 Hz. A
/// function of time only, so it does not depend on the partition of a run into ticks.
struct Tremor {
    static constexpr int tones = 8;
    static constexpr double low_hz = 8.0, high_hz = 12.0;

    double rms = 50e-6;  ///< m, per axis
    Random random{};

    /// Displacement in m and its velocity in m/s at time `t` s.
    void at(double t, Vec3& displacement, Vec3& velocity) const noexcept {
        displacement = velocity = Vec3(0.0);
        if (rms <= 0.0) return;
        const double amplitude = rms * std::sqrt(2.0 / tones);
        for (int axis = 0; axis < 3; ++axis)
            for (int tone = 0; tone < tones; ++tone) {
                const auto index = static_cast<std::uint64_t>(2 * (axis * tones + tone));
                const double hz = low_hz + (high_hz - low_hz) * (tone + random.uniform(index)) / tones;
                const double rate = 2.0 * std::numbers::pi * hz;
                const double phase = rate * t + 2.0 * std::numbers::pi * random.uniform(index + 1);
                displacement[axis] += amplitude * std::sin(phase);
                velocity[axis] += amplitude * rate * std::cos(phase);
            }
    }
};

}  // namespace tactus::simulate
