// SPDX-License-Identifier: Apache-2.0
// The inner loop of an admittance device: from where the finger should be to how fast the motor shall run.
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
    double least_speed = 0.0;       ///< m/s; the motor turns no slower than this. 0: it turns at any speed
    int delay = 1;                  ///< periods from a sample to the motion that follows from it
};

/// u = K (x_d − x_s) + f · ẋ_d, limited to what the motor can do. Of a motor that turns no slower than `least_speed`, a
/// command of less than half of that would be lost; so it is moved by single steps of one period at `least_speed`, each
/// when the finger is more than half a step away and the step before has come to be seen.
struct PositionLoop {
    /// Share of a step by which the finger must be off. Above 1/2, so that no step is followed by one back.
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

    int waits_ = 0;  // periods until a step is seen
};

}  // namespace tactus::control
