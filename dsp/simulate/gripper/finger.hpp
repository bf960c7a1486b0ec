// SPDX-License-Identifier: Apache-2.0
// One simulated finger of a gripper: motor, load and sensors.
#pragma once

#include "dsp/simulate/gripper/rig.hpp"
#include "dsp/simulate/gripper/sensors.hpp"
#include "dsp/simulate/gripper/traveling_wave_motor.hpp"
#include "dsp/simulate/gripper/walking_motor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

namespace tactus::simulate {

/// A simulated hand that squeezes and releases: it moves its finger in by `travel` m between `from` and `until` s.
struct Squeeze {
    double from = 0.5, until = 1e9;  ///< s
    double travel = 0.0;             ///< m
    double rise = 0.4;  ///< s, duration of closing and opening
    double period = 0.0;  ///< s, repetition period; 0: once. At least `until` + `rise`

    double at(double time) const noexcept {
        if (period > 0.0 && time > 0.0) time = std::fmod(time, period);
        const auto eased = [this](double t) {
            const double share = std::clamp(t / rise, 0.0, 1.0);
            return 0.5 - 0.5 * std::cos(std::numbers::pi * share);
        };
        return travel * (eased(time - from) - eased(time - until));
    }
};

/// Longest internal step, s: an eighth of the shortest time constant assumed for a motor.
inline constexpr double finger_substep_s = 0.125e-3;
inline constexpr int max_command_delay = 8;

struct Finger {
    std::variant<WalkingMotor, WaveMotor> motor;
    bool on_rig = true;  ///< loaded by the cord; else by the hand
    RigSprings rig;
    double hand_stiffness = 300.0;   ///< N/m, of a hand that squeezes
    Squeeze squeeze;
    Quantiser encoder, gauge;        ///< m, N
    int delay = 1;  ///< whole periods from a command to its effect, 0 to 8

    double position = 0.0;  ///< m, true value; + closes the finger
    double force = 0.0;  ///< N, true value, on the finger
    bool slipped = false;            ///< within the last `advance`

    /// Advances by `elapsed` s at the command `wanted` m/s, while the cord moves to `cord_end`.
    void advance(double wanted, double cord_end, double elapsed, bool free) noexcept {
        if (!(elapsed > 0.0)) return;
        for (std::size_t d = max_command_delay; d > 0; --d) told_[d] = told_[d - 1];
        told_[0] = wanted;
        const double command = told_[static_cast<std::size_t>(std::clamp(delay, 0, max_command_delay))];
        const int steps = std::max(1, static_cast<int>(std::ceil(elapsed / finger_substep_s - 1e-6)));
        const double h = elapsed / steps;
        // The servo interpolates between targets: cubic Hermite with the slopes of neighbouring targets.
        const double slope_begin = cord_slope_, slope_end = 1.5 * (cord_end - cord_) - 0.5 * slope_begin;
        slipped = false;
        for (int i = 0; i < steps; ++i) {
            const double s = (i + 0.5) / steps;
            const double cord = hermite(cord_, slope_begin, cord_end, slope_end, s);
            force = pull(cord, time_ + (i + 0.5) * h);
            position += h * std::visit([&](auto& m) { return speed_of(m, command, force, h, free); }, motor);
            slipped = slipped || std::visit([](const auto& m) { return m.slips; }, motor);
        }
        time_ += elapsed;
        cord_ = cord_end;
        cord_slope_ = slope_end;
        force = pull(cord_, time_);
    }
    bool limited() const noexcept {
        return std::visit([](const auto& m) { return m.limited; }, motor);
    }
    double cord() const noexcept { return cord_; }

private:
    double pull(double cord, double time) const noexcept {
        return on_rig ? rig.force(cord, position) : hand_stiffness * (squeeze.at(time) - position);
    }
    static double speed_of(WalkingMotor& m, double wanted, double load, double h, bool) noexcept {
        return m.advance(wanted, load, h);
    }
    static double speed_of(WaveMotor& m, double wanted, double load, double h, bool free) noexcept {
        return m.advance(wanted, load, h, free);
    }
    static double hermite(double a, double slope_a, double b, double slope_b, double s) noexcept {
        const double r = 1.0 - s;
        return a * r * r * (1.0 + 2.0 * s) + slope_a * s * r * r + b * s * s * (3.0 - 2.0 * s) - slope_b * s * s * r;
    }

    std::array<double, max_command_delay + 1> told_{};
    double time_ = 0.0, cord_ = 0.0, cord_slope_ = 0.0;
};

}  // namespace tactus::simulate
