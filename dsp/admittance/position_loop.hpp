// SPDX-License-Identifier: Apache-2.0
// The inner loop of an admittance device: from where the finger should be to how fast the motor shall run.
#pragma once

#include "dsp/filter/one_pole.hpp"

#include <algorithm>

namespace tactus {

struct PositionLoopSettings {
    double gain = 40.0;             ///< 1/s
    double feed_forward = 0.0;      ///< share of the wanted velocity, 0: the loop of the thesis
    double feed_forward_lag = 0.0;  ///< s, of its smoothing
    double max_speed = 0.07;        ///< m/s
};

/// u = K (x_d − x_s) + f · ẋ_d, limited to what the motor can do.
struct PositionLoop {
    OnePole smooth;
    bool saturated = false;  ///< the last command was cut

    /// One period of `period_s` in which the wanted position moved by `moved`. m, m/s.
    double operator()(const PositionLoopSettings& s, double wanted, double measured, double moved,
                      double period_s) noexcept {
        smooth.share = lag_share(s.feed_forward_lag, period_s);
        const double command = s.gain * (wanted - measured) + s.feed_forward * smooth(moved / period_s);
        const double given = std::clamp(command, -s.max_speed, s.max_speed);
        saturated = given != command;
        return given;
    }
    void rest() noexcept {
        smooth.y = 0.0;
        saturated = false;
    }
};

}  // namespace tactus
