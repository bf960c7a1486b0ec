// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/filter/one_pole.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::vibration {

namespace {

// 8 g peak to peak at 0.5 A through 4.5 Ω, in m/s² per V.
constexpr double mark_ii_sensitivity = 4.0 * 9.80665 / (0.5 * 4.5);

constexpr std::array<ActuatorModel, 3> models{{
    {"haptuator_small", 89.0, 0.23, 6.0, 128e-6, 3.0, 0.5, 24.5, 150.0, 0.020},
    {"haptuator_large", 73.0, 0.33, 6.0, 128e-6, 3.0, 0.5, 24.5, 150.0, 0.020},
    {"markII_D", 65.0, 0.38, 4.5, 128e-6, 3.0, 0.5, mark_ii_sensitivity, 65.0, 0.100},
}};

/// s² / (s² + 2 ζ ω0 s + ω0²) through the bilinear transform, exact at f0.
signal::BiquadCoefficients resonance(const ActuatorModel& model, double rate) {
    return signal::highpass(model.resonance, rate, 1.0 / (2.0 * model.damping));
}

double coil_gain(const ActuatorModel& model, double frequency) {
    const double x = 2.0 * std::numbers::pi * frequency * model.inductance / model.resistance;
    return 1.0 / std::sqrt(1.0 + x * x);
}

}  // namespace

std::span<const ActuatorModel> actuator_models() { return models; }

const ActuatorModel& find_actuator(std::string_view name) {
    std::vector<std::string> names;
    std::string list;
    for (const ActuatorModel& model : models) {
        if (model.name == name) return model;
        names.emplace_back(model.name);
        list += (list.empty() ? "" : ", ") + names.back();
    }
    throw Error("no actuator is called '" + std::string(name) + "'" + did_you_mean(name, names) + "; known are " +
                list);
}

Actuator::Actuator(const ActuatorModel& model, double mass, double rate) : rate_(rate), resistance_(model.resistance) {
    const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
    for (double value : {model.resonance, model.damping, model.resistance, model.voltage_limit, model.current_limit,
                         model.reference_acceleration, model.reference_frequency, model.reference_mass, mass, rate})
        if (!positive(value)) throw Error("every value of an actuator, its mass and its rate must be above 0");
    if (!(model.inductance >= 0.0)) throw Error("the inductance of an actuator must not be negative");
    if (!(std::max(model.resonance, model.reference_frequency) < 0.45 * rate))
        throw Error(fmt::format("an actuator with its resonance at {} Hz needs a higher rate than {} Hz",
                                model.resonance, rate));
    voltage_limit_ = std::min(model.voltage_limit, model.current_limit * model.resistance);
    coil_share_ = signal::lag_share(model.inductance / model.resistance, 1.0 / rate);
    resonator_.coefficients = resonance(model, rate);
    const double shape = std::abs(resonator_.coefficients.response(model.reference_frequency, rate)) *
                         coil_gain(model, model.reference_frequency);
    const double k = model.reference_acceleration / shape * model.reference_mass / mass;
    auto& c = resonator_.coefficients;
    c.b0 *= k, c.b1 *= k, c.b2 *= k;
}

ActuatorOutput Actuator::operator()(double drive) noexcept {
    const double asked = std::isfinite(drive) ? drive : 0.0;
    ActuatorOutput out;
    out.voltage = std::clamp(asked, -voltage_limit_, voltage_limit_);
    out.limited = out.voltage != asked;
    coil_ += coil_share_ * (out.voltage - coil_);
    out.current = coil_ / resistance_;
    out.acceleration = resonator_(coil_);
    return out;
}

double Actuator::gain(double frequency) const {
    const std::complex<double> z = std::polar(1.0, -2.0 * std::numbers::pi * frequency / rate_);
    return std::abs(resonator_.coefficients.response(frequency, rate_) * coil_share_ / (1.0 - (1.0 - coil_share_) * z));
}

}  // namespace tactus::vibration
