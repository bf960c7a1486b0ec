// SPDX-License-Identifier: Apache-2.0
// A simulated fracture surface: its height over a plane.
#pragma once

#include "dsp/core/random.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::plan {

/// A sum of sine waves in random directions, with wavelengths from 9 to 1.5 mm and smaller amplitudes for shorter
/// waves.
class RoughSurface {
public:
    /// `roughness`: root mean square height, m.
    RoughSurface(double roughness, std::uint64_t seed) {
        const Random random{seed};
        double power = 0.0;
        for (std::uint64_t n = 0; n < waves; ++n) {
            const double length = longest * std::pow(shortest / longest, static_cast<double>(n) / (waves - 1));
            const double angle = 2.0 * std::numbers::pi * random.uniform(3 * n);
            wave_[n] = {2.0 * std::numbers::pi / length * std::cos(angle),
                        2.0 * std::numbers::pi / length * std::sin(angle),
                        2.0 * std::numbers::pi * random.uniform(3 * n + 1), std::pow(length / longest, 1.3)};
            power += 0.5 * wave_[n].height * wave_[n].height;
        }
        for (Wave& wave : wave_) wave.height *= roughness / std::sqrt(power);
    }
    /// Height at (y, z) of the plane, m.
    double operator()(double y, double z) const {
        double height = 0.0;
        for (const Wave& wave : wave_) height += wave.height * std::sin(wave.y * y + wave.z * z + wave.phase);
        return height;
    }
    /// Root mean square slope.
    double slope() const {
        double squares = 0.0;
        for (const Wave& wave : wave_) squares += 0.5 * wave.height * wave.height * (wave.y * wave.y + wave.z * wave.z);
        return std::sqrt(squares);
    }

private:
    static constexpr std::uint64_t waves = 24;
    static constexpr double longest = 9e-3, shortest = 1.5e-3;
    struct Wave {
        double y, z, phase, height;
    };
    Wave wave_[waves];
};

}  // namespace tactus::plan
