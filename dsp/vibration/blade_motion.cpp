// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/blade_motion.hpp"

#include "dsp/signal/filter/one_pole.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::vibration {

BladeMotion::BladeMotion(double rate, const SawBehaviour& behaviour)
    : behaviour_(behaviour),
      rate_(rate),
      up_share_(signal::lag_share(behaviour.spin_up_time, 1.0 / rate)),
      down_share_(signal::lag_share(behaviour.spin_down_time, 1.0 / rate)) {}

void BladeMotion::command(double thrust, bool trigger, double commanded_rate, std::optional<bool> contact) noexcept {
    loaded_ = contact ? *contact : thrust > (loaded_ ? behaviour_.load_off : behaviour_.load_on);
    const double wanted = trigger && commanded_rate > 0.0 ? std::min(commanded_rate, greatest_rate) : 0.0;
    blade_rate_ += (wanted > 0.0 ? up_share_ : down_share_) * (wanted - blade_rate_);
    if (wanted == 0.0 && blade_rate_ < 1.0) {
        blade_rate_ = 0.0;
        state_ = SawState::off;
        return;
    }
    if (wanted == 0.0) {
        state_ = SawState::spin_down;
    } else if (state_ == SawState::off || state_ == SawState::spin_down) {
        state_ = SawState::spin_up;
    }
    const bool reached = std::abs(blade_rate_ - wanted) < 0.02 * wanted;
    if (wanted > 0.0 && (state_ != SawState::spin_up || reached)) state_ = loaded_ ? SawState::cutting : SawState::idle;
}

}  // namespace tactus::vibration
