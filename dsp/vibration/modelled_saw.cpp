// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/modelled_saw.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/prediction/burg.hpp"
#include "dsp/signal/prediction/line_frequencies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace tactus::vibration {

namespace {

constexpr double highest_share = 0.42;  // of the output's rate: orders above it would alias when the blade speeds up
constexpr double min_swell = 0.02;    // of the mean power
constexpr Random noise{0x7ac705};

}  // namespace

void ModelledSaw::prepare(double rate, const SawModel& model, const SawBehaviour& behaviour) {
    if (!(std::isfinite(rate) && rate >= SawModelSize::residual_rate))
        throw Error(fmt::format("a modelled saw needs a group at {:g} Hz or more, not {:g} Hz",
                                SawModelSize::residual_rate, rate));
    *this = ModelledSaw{};
    sounds_ = SawSounds(model);
    behaviour_ = behaviour;
    blade_ = BladeMotion(rate, behaviour);
    rate_ = rate;
    interval_share_ = signal::lag_share(behaviour.fade_time, interval / rate);
    fade_step_ = behaviour.fade_time * rate > interval ? interval / (behaviour.fade_time * rate) : 1.0;
    for (std::size_t k = 0; k < model.phases.size(); ++k) {
        cos_[k] = std::numbers::sqrt2 * std::cos(model.phases[k]);
        sin_[k] = std::numbers::sqrt2 * std::sin(model.phases[k]);
    }
    for (const SawCondition& condition : model.conditions)
        for (std::size_t k = 0; k < condition.sound.orders.size(); ++k)
            if (condition.sound.orders[k] > 0.0) order_count_ = std::max(order_count_, k + 1);
}

void ModelledSaw::aim() noexcept {
    const double wanted = blade_.loaded() ? 1.0 : 0.0;
    if (started_) {
        load_ += interval_share_ * (wanted_load_ - load_);
        density_ += interval_share_ * (wanted_density_ - density_);
        cutting_ += std::clamp(wanted - cutting_, -fade_step_, fade_step_);
    } else {
        load_ = wanted_load_;
        density_ = wanted_density_;
        cutting_ = wanted;
        started_ = true;
    }
    const double speed = blade_.rate();
    sound_ = cutting_ >= 1.0   ? sounds_.at(true, speed, load_, density_)
             : cutting_ <= 0.0 ? sounds_.at(false, speed, 0.0, 0.0)
                               : SawSounds::blend(sounds_.at(false, speed, 0.0, 0.0),
                                                  sounds_.at(true, speed, load_, density_), cutting_);
    for (std::size_t k = 0; k < order_count_; ++k) {
        const bool heard = static_cast<double>(k + 1) * speed < highest_share * rate_;
        step_[k] = ((heard ? sound_.orders[k] : 0.0) - level_[k]) / interval;
    }
    signal::predictor_of_lines(sound_.lines, predictor_);
    std::array<double, SawModelSize::lines> reflection = predictor_;
    // Means of stable filters are stable; rounding cannot be excluded.
    excitation_ =
        signal::reflection_of(reflection) ? sound_.residual / std::sqrt(signal::prediction_gain(reflection)) : 0.0;
    until_next_ = interval;
}

double ModelledSaw::orders() noexcept {
    const double angle = 2.0 * pi * (blade_.cycles() - std::floor(blade_.cycles()));
    const std::complex<double> turn{std::cos(angle), std::sin(angle)};
    double re = turn.real(), im = turn.imag(), sum = 0.0;
    for (std::size_t k = 0; k < order_count_; ++k) {
        level_[k] += step_[k];
        sum += level_[k] * (re * cos_[k] - im * sin_[k]);
        const double next = re * turn.real() - im * turn.imag();
        im = re * turn.imag() + im * turn.real();
        re = next;
    }
    return sum;
}

void ModelledSaw::add_noise() noexcept {
    // The sinc reads eight samples behind the newest.
    const double cycles = blade_.cycles() + reading_half * blade_.rate() / SawModelSize::residual_rate;
    const double angle = 2.0 * pi * (cycles - std::floor(cycles));
    double power = 1.0;
    for (std::size_t m = 0; m < SawModelSize::swells; ++m) {
        const double at = static_cast<double>(m + 1) * angle;
        power += sound_.swell_cos[m] * std::cos(at) + sound_.swell_sin[m] * std::sin(at);
    }
    double value = excitation_ * std::sqrt(std::max(power, min_swell)) * noise.normal(drawn_++);
    for (std::size_t k = 0; k < kept; ++k) value -= predictor_[k] * past_[k];
    std::move_backward(past_.begin(), past_.end() - 1, past_.end());
    past_[0] = value;
    std::move(around_.begin() + 1, around_.end(), around_.begin());
    around_.back() = static_cast<float>(value);
}

double ModelledSaw::residual() noexcept {
    position_ += SawModelSize::residual_rate / rate_;
    while (position_ >= 1.0) {
        position_ -= 1.0;
        add_noise();
    }
    return read_between(around_.data(), position_);
}

float ModelledSaw::tick(double load, double density, bool trigger, double commanded_rate,
                        std::optional<bool> contact) noexcept {
    wanted_load_ = std::isfinite(load) ? load : 0.0;
    wanted_density_ = std::isfinite(density) ? density : 0.0;
    blade_.command(wanted_load_, trigger, commanded_rate, contact);
    if (blade_.state() == SawState::off) {
        // The next start begins in silence.
        level_.fill(0.0);
        past_.fill(0.0);
        around_.fill(0.0f);
        until_next_ = 0;
        return 0.0f;
    }
    if (until_next_ == 0) aim();
    --until_next_;
    const double value = behaviour_.gain * (orders() + residual());
    blade_.advance();
    return static_cast<float>(value);
}

}  // namespace tactus::vibration
