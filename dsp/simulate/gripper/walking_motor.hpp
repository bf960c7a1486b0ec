// SPDX-License-Identifier: Apache-2.0
// Walking quasi-static piezo motor (thesis 2.5.2.2, 6.3.1) with a lever, seen at the finger.
#pragma once

#include "dsp/signal/filter/one_pole.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::simulate {

/// From the thesis: drive_limit, leverage, and the step, which follows from 70 mm/s at the finger. Assumed, as the
/// thesis does not state them: lag (1 to 4 ms), holding force (3.5 to 5 N at the finger: 20 N of the motor's data sheet
/// through the leverage, ± a quarter), slip_damping.
struct WalkingMotorSettings {
    double step = 0.07 / 4.5 / 3000.0;  ///< m of the rod per drive cycle: 5.19 µm
    double drive_limit = 3000.0;  ///< Hz; higher rates may damage the motor
    double leverage = 4.5;  ///< speed of the finger over that of the rod
    double lag = 0.002;  ///< s
    double holding_force = 4.4;  ///< N at the finger; above it the rod slips
    double slip_damping = 20.0;  ///< N·s/m while it slips

    double max_speed() const noexcept { return step * drive_limit * leverage; }  ///< m/s at the finger
};

/// Speed of a finger that a motor drives by friction at `speed`: a load above the holding force makes it slip, which
/// the motor cannot prevent.
inline double yielding(double speed, double load, double holding_force, double slip_damping, bool& slips) noexcept {
    const double excess = std::abs(load) - holding_force;
    slips = excess > 0.0;
    if (!slips) return speed;
    return std::copysign(std::max(excess / slip_damping, std::copysign(1.0, load) * speed), load);
}

struct WalkingMotor {
    WalkingMotorSettings settings;
    double speed = 0.0;  ///< m/s, of the legs, at the finger
    bool slips = false;
    bool limited = false;  ///< the command exceeded drive_limit

    /// Speed of the finger over the next `h` s, at the command `wanted` m/s with `load` N on the finger.
    double advance(double wanted, double load, double h) noexcept {
        const double drive = wanted / (settings.step * settings.leverage);  // Hz, its sign the direction
        limited = std::abs(drive) > settings.drive_limit * (1.0 + 1e-9);
        const double cycles = std::clamp(drive, -settings.drive_limit, settings.drive_limit);
        speed += signal::lag_share(settings.lag, h) * (cycles * settings.step * settings.leverage - speed);
        return yielding(speed, load, settings.holding_force, settings.slip_damping, slips);
    }
};

}  // namespace tactus::simulate
