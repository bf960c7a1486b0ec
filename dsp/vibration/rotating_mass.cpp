// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/rotating_mass.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::vibration {

RotatingMass::RotatingMass(const RotatingMassModel& model, double mass, double rate) : model_(model) {
    for (const double value : {model.rated_voltage, model.rated_speed, model.rise_time, model.unbalance,
                               model.resistance, model.voltage_limit, mass, rate})
        if (!(std::isfinite(value) && value > 0.0))
            throw Error("every value of a rotating mass, its mass and its rate must be above 0");
    const double fastest = model.rated_speed * model.voltage_limit / model.rated_voltage;
    if (!(fastest < 0.9 * pi * rate))
        throw Error(fmt::format("a mass that turns {:.4g} times a second needs a higher rate than {} Hz",
                                fastest / (2.0 * pi), rate));
    step_ = 1.0 / rate;
    decay_ = std::exp(-step_ / model.rise_time);
    acceleration_ = model.unbalance / mass;
}

ActuatorOutput RotatingMass::operator()(double drive) noexcept {
    const double asked = std::isfinite(drive) ? drive : 0.0;
    ActuatorOutput out;
    out.voltage = std::clamp(asked, -model_.voltage_limit, model_.voltage_limit);
    out.limited = out.voltage != asked;
    // Friction holds a mass that stands still.
    const bool is_held = std::abs(speed_) < 0.01 * model_.rated_speed && std::abs(out.voltage) < model_.start_voltage;
    const double wanted = is_held ? 0.0 : model_.rated_speed * out.voltage / model_.rated_voltage;
    const double before = speed_;
    speed_ = wanted + decay_ * (speed_ - wanted);
    if (std::abs(speed_) < 1e-9 * model_.rated_speed) speed_ = 0.0;  // keeps the decay out of denormal numbers
    angle_ = std::remainder(angle_ + 0.5 * (before + speed_) * step_, 2.0 * pi);
    out.acceleration = acceleration_ * speed_ * speed_ * std::sin(angle_);
    // The back-EMF is the voltage less the resistive part at the rated speed without load.
    out.current = (out.voltage - speed_ * model_.rated_voltage / model_.rated_speed) / model_.resistance;
    return out;
}

double RotatingMass::frequency() const noexcept { return std::abs(speed_) / (2.0 * pi); }

}  // namespace tactus::vibration
