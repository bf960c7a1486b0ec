// SPDX-License-Identifier: Apache-2.0
// The sound of a modelled saw between its recorded conditions.
#pragma once

#include "dsp/vibration/saw_model.hpp"

#include <cstddef>
#include <vector>

namespace tactus::vibration {

/// Continuous in rate, load and density. Linear in the load, then in the density, then in the logarithm of the rate;
/// before interpolation, orders are scaled by the square of the rate, like the acceleration of a constant stroke, and
/// the residual by the rate. Below the lowest recorded load, cutting becomes free air as the load falls to 0; outside
/// of the recorded densities, and above the highest load, the nearest is used; above the highest rate the level stays,
/// below the lowest it falls as scaled.
class SawSounds {
public:
    SawSounds() = default;
    /// Without free-air conditions, cutting ones 12 dB lower replace them; without cutting ones, free-air ones replace
    /// them unchanged. Throws Error when the model has no condition, or more than `max_conditions`. Allocates.
    explicit SawSounds(const SawModel& model);

    /// `rate` in Hz, `load` in N, `density` in kg/m³ (0: unknown, the middle of the recorded ones). Does not allocate.
    SawSound at(bool cutting, double rate, double load, double density) const noexcept;

    /// Returns whether a condition lies between recorded ones in load, density and rate, so that nothing is
    /// extrapolated.
    bool covers(bool cutting, double rate, double load, double density) const noexcept;

    /// Returns the mixture with the fraction x of `b` and 1 − x of `a`.
    static SawSound blend(const SawSound& a, const SawSound& b, double x) noexcept;

private:
    struct Point {
        double load;
        SawSound sound;
    };
    struct Bone {
        double density;
        std::vector<Point> points;  // by load; free air, where it was recorded, is the load 0
    };
    struct Speed {
        double rate;
        std::vector<Bone> bones;  // by density
    };
    void add(bool cutting, const SawCondition& condition, double gain);
    static bool covers(const Speed& speed, double load, double density) noexcept;
    static SawSound at_load(const Bone& bone, double load) noexcept;
    static SawSound at_speed(const Speed& speed, double rate, double load, double density) noexcept;

    std::vector<Speed> speeds_[2];  // free air, cutting; by rate
    bool recorded_[2] = {false, false};
};

}  // namespace tactus::vibration
