// SPDX-License-Identifier: Apache-2.0
// Position loop of an admittance device: from the wanted position of the finger to the speed of the motor.
#pragma once

#include "dsp/signal/filter/one_pole.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::control {

struct PositionLoopSettings {
    double gain = 40.0;             ///< 1/s
    double feed_forward = 0.0;      ///< share of the wanted velocity, 0: the loop of the thesis
    double feed_forward_lag = 0.0;  ///< s, of its smoothing
    double max_speed = 0.07;        ///< m/s
    double least_speed = 0.0;  ///< m/s, slowest speed that the motor can run at. 0: none
    int delay = 1;  ///< periods from a sample to the resulting motion
};

/// u = K (x_d − x_s) + f · ẋ_d, clamped to the motor's limits. A motor that cannot run slower than `least_speed` would
/// lose commands below half of it; it is moved by single steps of one period at `least_speed` instead, each when the
/// finger is more than half a step off and the previous step has become visible in the position.
struct PositionLoop {
    /// Position error per step, above which a step is made. More than 1/2, so that no step is followed by one back.
    static constexpr double worth_a_step = 0.6;

    signal::OnePole smooth;
    bool saturated = false;  ///< the last command was cut

    /// One period of `period_s` in which the wanted position moved by `moved`. m, m/s.
    double operator()(const PositionLoopSettings& s, double wanted, double measured, double moved,
                      double period_s) noexcept {
        smooth.share = signal::lag_share(s.feed_forward_lag, period_s);
        const double command = s.gain * (wanted - measured) + s.feed_forward * smooth(moved / period_s);
        if (std::abs(command) < 0.5 * s.least_speed) {
            saturated = false;
            return step(wanted - measured, s, period_s);
        }
        waits_ = 0;
        const double given = std::clamp(command, -s.max_speed, s.max_speed);
        saturated = given != command;
        return given;
    }
    void rest() noexcept {
        smooth.y = 0.0;
        saturated = false;
        waits_ = 0;
    }

private:
    double step(double error, const PositionLoopSettings& s, double period_s) noexcept {
        if (waits_ > 0) {
            --waits_;
            return 0.0;
        }
        if (std::abs(error) < worth_a_step * s.least_speed * period_s) return 0.0;
        waits_ = s.delay + 1;  // one more for the motor's lag
        return std::copysign(std::min(s.least_speed, s.max_speed), error);
    }

    int waits_ = 0;  // periods until a step is visible
};

}  // namespace tactus::control
