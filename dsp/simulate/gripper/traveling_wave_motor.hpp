// SPDX-License-Identifier: Apache-2.0
// Traveling-wave ultrasonic motor (thesis 2.5.2.1, 6.3.2) that drives a finger directly.
#pragma once

#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/simulate/gripper/walking_motor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::simulate {

/// The two sinusoidal voltages of the stator.
struct WaveDrive {
    double frequency = 0.0;  ///< Hz
    double phase = 0.0;  ///< rad between the two; the sign gives the direction
    double amplitude = 0.0;  ///< share of the full voltage, 0 to 1
};

/// The quantity that the driver varies to set the speed.
enum class WaveControl : std::uint8_t { frequency, phase, amplitude };

/// From the thesis: the speed falls off the resonance and off 90°, the sign of the phase is the direction, amplitude
/// control works too; and the gripper's encoder. Assumed, with the range over which findings must hold:
/// max_speed 0.4 to 0.8 m/s, least_speed 15 to 30 mm/s, dead_zone 5 to 15 mm/s, lag 3 to 10 ms, holding force 2.5 to 4
/// N.
struct WaveMotorSettings {
    double resonance = 40e3;  ///< Hz
    double width = 800.0;  ///< Hz above the resonance at which the speed is 1/√2
    double max_speed = 0.6;  ///< m/s of the finger at resonance, 90° and full amplitude
    double least_speed = 0.03;  ///< m/s, slowest motion that a wave can drive
    double dead_zone = 0.015;  ///< m/s, commands below it give no motion
    double lag = 0.004;  ///< s
    double holding_force = 3.0;  ///< N at the finger
    double slip_damping = 20.0;  ///< N·s/m while it slips
    double low_friction = 1.5;  ///< N·s/m that remains when a standing wave lifts the rotor
};

struct WaveMotor {
    WaveMotorSettings settings;
    WaveControl control = WaveControl::phase;
    double speed = 0.0;  ///< m/s, speed that the wave gives the finger
    bool slips = false, limited = false;

    /// m/s without load; 0 where the wave is too weak to drive the rotor.
    double speed_of(const WaveDrive& drive) const noexcept {
        const double off = std::max(0.0, drive.frequency - settings.resonance) / settings.width;
        const double v = settings.max_speed * std::clamp(drive.amplitude, 0.0, 1.0) * std::sin(drive.phase) /
                         std::sqrt(1.0 + off * off);
        return std::abs(v) < settings.least_speed * (1.0 - 1e-9) ? 0.0 : v;
    }

    /// The drive for a speed: 0 within the dead zone, otherwise clamped between the slowest and the fastest.
    WaveDrive drive_for(double wanted) const noexcept {
        const double right_angle = 0.5 * std::numbers::pi;
        WaveDrive drive{settings.resonance, std::copysign(right_angle, wanted), 1.0};
        if (std::abs(wanted) < settings.dead_zone) return {settings.resonance, 0.0, 0.0};
        const double share =
            std::clamp(std::abs(wanted), settings.least_speed, settings.max_speed) / settings.max_speed;
        switch (control) {
            case WaveControl::frequency:
                drive.frequency += settings.width * std::sqrt(std::max(0.0, 1.0 / (share * share) - 1.0));
                break;
            case WaveControl::phase: drive.phase = std::copysign(std::asin(share), wanted); break;
            case WaveControl::amplitude: drive.amplitude = share; break;
        }
        return drive;
    }

    /// Speed of the finger over the next `h` s. `free`: low-friction mode, in which the load moves the finger.
    double advance(double wanted, double load, double h, bool free) noexcept {
        limited = std::abs(wanted) > settings.max_speed * (1.0 + 1e-9);
        slips = false;
        const double driven = free ? 0.0 : speed_of(drive_for(wanted));
        speed += signal::lag_share(settings.lag, h) * (driven - speed);
        if (free) return speed + load / settings.low_friction;
        return yielding(speed, load, settings.holding_force, settings.slip_damping, slips);
    }
};

}  // namespace tactus::simulate
