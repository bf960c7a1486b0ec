// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::vibration {

namespace {

// 8 g peak to peak at 0.5 A, in m/s² per A.
constexpr double mark_ii_sensitivity = 4.0 * 9.80665 / 0.5;

// 2 g rms at 2.5 V rms.
constexpr double lra_sensitivity = 2.0 * 9.80665 / 2.5;

constexpr std::array<ActuatorModel, 5> models{{
    {"haptuator_small", 89.0, 0.23, 0.020, 4.4e-3, 6.0, 128e-6, 3.0, 0.5, 24.5, false, 150.0, 0.020},
    {"haptuator_large", 73.0, 0.33, 0.020, 4.4e-3, 6.0, 128e-6, 3.0, 0.5, 24.5, false, 150.0, 0.020},
    {"markII_D", 65.0, 0.38, 0.100, 4.4e-3, 4.5, 128e-6, 3.0, 0.5, mark_ii_sensitivity, true, 65.0, 0.100},
    {"lra_10mm", 170.0, 0.065, 0.100, 1.3e-3, 12.0, 100e-6, 3.54, 0.24, lra_sensitivity, false, 170.0, 0.100},
    {"voice_coil_14mm", 120.0, 0.3, 0.100, 5e-3, 7.8, 50e-6, 3.53, 0.45, 0.0, false, 0.0, 0.0, 2.4},
}};

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

double reduced_mass(double moving, double total) { return moving * (total - moving) / total; }

void check(const ActuatorModel& model) {
    const bool by_reference = !(model.force_factor > 0.0);
    for (const double value :
         {model.resonance, model.damping, model.resonance_mass, model.moving_mass, model.resistance,
          model.voltage_limit, model.current_limit, by_reference ? model.reference_acceleration : model.force_factor,
          by_reference ? model.reference_frequency : 1.0, by_reference ? model.reference_mass : 1.0})
        if (!positive(value)) throw Error("every value of an actuator, its mass and its rate must be above 0");
    if (!(std::isfinite(model.inductance) && model.inductance >= 0.0))
        throw Error("the inductance of an actuator must not be negative");
    const double total = by_reference ? std::min(model.resonance_mass, model.reference_mass) : model.resonance_mass;
    if (!(model.moving_mass < total))
        throw Error(fmt::format("the moving mass of an actuator, {:g} g, must be less than its total mass, {:g} g",
                                1e3 * model.moving_mass, 1e3 * total));
}

void check_mass(const ActuatorModel& model, double mass) {
    if (!(positive(mass) && mass > model.moving_mass))
        throw Error(fmt::format("an actuator with {:g} g of moving mass needs a total mass above that, not {:g} g",
                                1e3 * model.moving_mass, 1e3 * mass));
}

using Matrix = std::array<std::array<double, 4>, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k < 4; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// e^a by Taylor's series of a scaled down, squared as often.
Matrix exponential(Matrix a) {
    double norm = 0.0;
    for (const auto& row : a)
        for (const double x : row) norm = std::max(norm, std::abs(x));
    int halvings = 0;
    for (; norm > 0.05; norm *= 0.5) ++halvings;
    for (auto& row : a)
        for (double& x : row) x = std::ldexp(x, -halvings);
    Matrix out{}, term{};
    for (std::size_t i = 0; i < 4; ++i) out[i][i] = term[i][i] = 1.0;
    for (int n = 1; n <= 12; ++n) {
        term = product(term, a);
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) out[i][j] += term[i][j] /= n;
    }
    for (int i = 0; i < halvings; ++i) out = product(out, out);
    return out;
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

namespace {

/// `critical`: 2 ω0 m, N·s/m: the damping of ratio 1.
void check_damping(const ActuatorModel& model, const ActuatorMechanics& mechanics, double ratio, double critical) {
    if (mechanics.damping >= 0.0) return;
    const double electrical = mechanics.force_factor * mechanics.force_factor / model.resistance;
    throw Error(fmt::format(
        "the back-EMF of this coil, {:.3g} N/A with {:g} ohm, alone has a damping ratio of {:.3g}, more than "
        "the stated {:g}: give a smaller force factor, more damping or more moving mass",
        mechanics.force_factor, model.resistance, electrical / critical, ratio));
}

}  // namespace

ActuatorMechanics mechanics_of(const ActuatorModel& model) {
    check(model);
    const double omega = 2.0 * pi * model.resonance, m = model.moving_mass;
    const double reduced = reduced_mass(m, model.resonance_mass);
    ActuatorMechanics out;
    out.stiffness = omega * omega * reduced;
    const double all = 2.0 * model.damping * omega * reduced;  // mechanical and electrical, N·s/m
    const auto finish = [&] {
        out.damping = all - out.force_factor * out.force_factor / model.resistance;
        check_damping(model, out, model.damping, 2.0 * omega * reduced);
        return out;
    };
    if (model.force_factor > 0.0) {
        out.force_factor = model.force_factor;
        return finish();
    }
    // At the reference: the housing's acceleration is the moving mass' against it, times m/M, and that is the coil's
    // force through the spring and the dampers.
    const double there = 2.0 * pi * model.reference_frequency, total = model.reference_mass;
    const double spring = out.stiffness - there * there * reduced_mass(m, total);
    const double response = m / total * there * there;  // m/s² of the housing per m
    // The coil lags behind the voltage; its inductance counts little at these frequencies, but it does count.
    const double lag = std::hypot(1.0, there * model.inductance / model.resistance);
    if (model.per_ampere) {
        // |a/i| = response Bl / |spring + j ω c| with c = all − Bl²/R: found between none and all damping electrical.
        const auto sensitivity = [&](double factor) {
            const double c = all - factor * factor / model.resistance;
            return response * factor / std::hypot(spring, there * c);
        };
        double low = 0.0, high = std::sqrt(all * model.resistance);
        if (sensitivity(high) < model.reference_acceleration)
            throw Error("no actuator of these masses, this damping and this resistance shakes as much as stated");
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            (sensitivity(middle) < model.reference_acceleration ? low : high) = middle;
        }
        out.force_factor = 0.5 * (low + high);
    } else {
        out.force_factor =
            model.reference_acceleration * model.resistance * lag * std::hypot(spring, there * all) / response;
    }
    return finish();
}

ActuatorMechanics tuned(const ActuatorModel& model, ActuatorMechanics mechanics, double mass, double frequency,
                        double damping_ratio) {
    check_mass(model, mass);
    const double omega = 2.0 * pi * frequency, reduced = reduced_mass(model.moving_mass, mass);
    mechanics.stiffness = omega * omega * reduced;
    if (damping_ratio > 0.0) {
        mechanics.damping =
            2.0 * damping_ratio * omega * reduced - mechanics.force_factor * mechanics.force_factor / model.resistance;
        check_damping(model, mechanics, damping_ratio, 2.0 * omega * reduced);
    }
    return mechanics;
}

ActuatorResonance resonance_on(const ActuatorModel& model, double mass) {
    check_mass(model, mass);
    const double ratio = reduced_mass(model.moving_mass, model.resonance_mass) / reduced_mass(model.moving_mass, mass);
    return {model.resonance * std::sqrt(ratio), model.damping * std::sqrt(ratio)};
}

Actuator::Actuator(const ActuatorModel& model, double mass, double rate)
    : Actuator(model, mechanics_of(model), mass, rate) {}

Actuator::Actuator(const ActuatorModel& model, const ActuatorMechanics& mechanics, double mass, double rate)
    : rate_(rate) {
    check(model);
    check_mass(model, mass);
    if (!positive(rate)) throw Error("every value of an actuator, its mass and its rate must be above 0");
    const double reduced = reduced_mass(model.moving_mass, mass), housing = mass - model.moving_mass;
    const double omega = std::sqrt(mechanics.stiffness / reduced);
    if (!(std::max(omega / (2.0 * pi), model.reference_frequency) < 0.45 * rate))
        throw Error(fmt::format("an actuator with its resonance at {:.4g} Hz needs a higher rate than {} Hz",
                                omega / (2.0 * pi), rate));
    voltage_limit_ = model.voltage_limit;
    current_limit_ = model.current_limit;
    // For a steady tone: back-EMF and inductance only add to the resistance.
    safe_voltage_ = std::min(model.voltage_limit, model.current_limit * model.resistance);

    // A coil without inductance follows within a thousandth of a sample.
    const double inductance = std::max(model.inductance, 1e-3 * model.resistance / rate);
    const double factor = mechanics.force_factor, k = mechanics.stiffness, c = mechanics.damping;
    // Current, displacement, speed, voltage; per second.
    const Matrix change{{{-model.resistance / inductance, 0.0, -factor / inductance, 1.0 / inductance},
                         {0.0, 0.0, 1.0, 0.0},
                         {factor / reduced, -k / reduced, -c / reduced, 0.0},
                         {0.0, 0.0, 0.0, 0.0}}};
    // In units in which all four are of one size: the exponential is then exact to rounding.
    const std::array<double, 4> unit{1.0, factor / k, omega * factor / k, model.resistance};
    Matrix scaled{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) scaled[i][j] = change[i][j] * unit[j] / unit[i] / rate;
    const Matrix after = exponential(scaled);
    for (std::size_t i = 0; i < states; ++i) {
        for (std::size_t j = 0; j < states; ++j) step_[i][j] = after[i][j] * unit[i] / unit[j];
        input_[i] = after[i][3] * unit[i] / unit[3];
    }
    output_ = {-factor / housing, k / housing, c / housing};
}

ActuatorOutput Actuator::operator()(double drive) noexcept {
    const double asked = std::isfinite(drive) ? drive : 0.0;
    ActuatorOutput out;
    out.voltage = std::clamp(asked, -voltage_limit_, voltage_limit_);
    State free{};
    for (std::size_t i = 0; i < states; ++i)
        for (std::size_t j = 0; j < states; ++j) free[i] += step_[i][j] * state_[j];
    const double current = free[0] + input_[0] * out.voltage;
    if (std::abs(current) > current_limit_)
        out.voltage =
            std::clamp((std::copysign(current_limit_, current) - free[0]) / input_[0], -voltage_limit_, voltage_limit_);
    out.limited = out.voltage != asked;
    // Far below what any converter resolves; keeps the decay out of denormal numbers.
    constexpr double least = 1e-30;
    for (std::size_t i = 0; i < states; ++i) {
        state_[i] = free[i] + input_[i] * out.voltage;
        if (std::abs(state_[i]) < least) state_[i] = 0.0;
    }
    out.current = state_[0];
    for (std::size_t i = 0; i < states; ++i) out.acceleration += output_[i] * state_[i];
    return out;
}

double Actuator::gain(double frequency) const {
    // Solves (z − step) x = input by Cramer's rule.
    using Complex = std::complex<double>;
    const Complex z = std::polar(1.0, 2.0 * pi * frequency / rate_);
    std::array<std::array<Complex, states>, states> a{};
    for (std::size_t i = 0; i < states; ++i)
        for (std::size_t j = 0; j < states; ++j) a[i][j] = (i == j ? z : Complex(0.0)) - step_[i][j];
    const auto determinant = [](const auto& m) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    Complex sum = 0.0;
    for (std::size_t column = 0; column < states; ++column) {
        auto replaced = a;
        for (std::size_t i = 0; i < states; ++i) replaced[i][column] = input_[i];
        sum += output_[column] * determinant(replaced);
    }
    return std::abs(sum / determinant(a));
}

}  // namespace tactus::vibration
