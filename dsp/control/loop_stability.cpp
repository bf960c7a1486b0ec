// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/loop_stability.hpp"

#include "dsp/signal/filter/one_pole.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::control {

namespace {

constexpr int max_delay = 8;

/// Indices of the loop's parts in its state.
enum : std::size_t { finger, speed, wanted, wanted_speed, smoothed, told };

using State = std::array<double, max_loop_states>;

State advance(const LoopModel& m, const HeldStep& object, int delay, const State& s) noexcept {
    const double force = -m.hand_stiffness * s[finger];
    State next{};
    if (!m.is_wall) {
        next[wanted] = object.xx * s[wanted] + object.xv * s[wanted_speed] + object.xf * force;
        next[wanted_speed] = object.vx * s[wanted] + object.vv * s[wanted_speed] + object.vf * force;
    }
    const double velocity = (next[wanted] - s[wanted]) / m.period;
    next[smoothed] = s[smoothed] + signal::lag_share(m.feed_forward_lag, m.period) * (velocity - s[smoothed]);
    const double command = m.gain * (next[wanted] - s[finger]) + m.feed_forward * next[smoothed];
    for (int d = delay - 1; d > 0; --d)
        next[told + static_cast<std::size_t>(d)] = s[told + static_cast<std::size_t>(d) - 1];
    if (delay > 0) next[told] = command;
    const double acts = delay > 0 ? s[told + static_cast<std::size_t>(delay) - 1] : command;
    const double gained = signal::lag_share(m.motor_lag, m.period),
                 run_on = m.motor_lag > 0.0 ? m.motor_lag * gained : 0.0;
    next[speed] = s[speed] + gained * (acts - s[speed]);
    next[finger] = s[finger] + run_on * s[speed] + (m.period - run_on) * acts;
    return next;
}

LoopModel with(LoopModel model, const ObjectSettings& object, bool in_contact) noexcept {
    // Without a hand stiffness the object is outside of the loop, like a wall.
    model.is_wall = (in_contact && object.kind == ObjectKind::wall) || !(model.hand_stiffness > 0.0);
    model.stiffness = in_contact ? object.stiffness : 0.0;
    model.damping = in_contact ? object.damping : object.free_damping;
    model.mass = object.mass;
    if (in_contact && object.kind == ObjectKind::table) {
        model.stiffness = object.table->min_stiffness();
        model.damping = model.mass = 0.0;
        model.is_wall = model.is_wall || !std::isfinite(model.stiffness);
    }
    return model;
}

}  // namespace

LoopMatrix loop_matrix(const LoopModel& model) noexcept {
    const int delay = std::clamp(model.delay, 0, max_delay);
    const HeldStep object =
        model.is_wall ? HeldStep{} : held_step(model.stiffness, model.damping, model.mass, model.period);
    LoopMatrix matrix;
    matrix.size = told + static_cast<std::size_t>(delay);
    for (std::size_t column = 0; column < matrix.size; ++column) {
        State unit{};
        unit[column] = 1.0;
        const State image = advance(model, object, delay, unit);
        for (std::size_t row = 0; row < matrix.size; ++row) matrix.at[row][column] = image[row];
    }
    return matrix;
}

namespace {

/// Largest absolute row sum: an upper bound of the spectral radius.
double norm_of(const LoopMatrix& a) noexcept {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size; ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < a.size; ++j) sum += std::abs(a.at[i][j]);
        most = std::max(most, sum);
    }
    return most;
}

/// ‖A^(2^n)‖^(1/2^n) for n up to `squarings`, or until `decided(log of it, share 1/2^n)`.
template <class Decided>
double log_radius(LoopMatrix a, int squarings, Decided&& decided) noexcept {
    double scaled = 0.0, share = 1.0;  // logarithm of the removed scale, per power of A
    for (int n = 0;; ++n, share *= 0.5) {
        const double norm = norm_of(a);
        if (!(norm > 0.0)) return -std::numeric_limits<double>::infinity();
        if (!std::isfinite(norm)) return std::numeric_limits<double>::infinity();
        const double bound = scaled + share * std::log(norm);
        if (n == squarings || decided(bound, share)) return bound;
        scaled = bound;
        LoopMatrix square;
        square.size = a.size;
        for (std::size_t i = 0; i < a.size; ++i)
            for (std::size_t k = 0; k < a.size; ++k) {
                const double f = a.at[i][k] / norm;
                if (f == 0.0) continue;
                for (std::size_t j = 0; j < a.size; ++j) square.at[i][j] += f * (a.at[k][j] / norm);
            }
        a = square;
    }
}

}  // namespace

double spectral_radius(const LoopMatrix& matrix) noexcept {
    return std::exp(log_radius(matrix, 24, [](double, double) { return false; }));
}

bool is_stable(const LoopModel& model) noexcept {
    // A power with norm below 1 proves stability; a norm of a billion would need a transient that no such loop
    // has.
    const double margin = std::log1p(-1e-6);
    return log_radius(loop_matrix(model), 24,
                      [margin](double bound, double share) { return bound < margin || bound > 20.0 * share; }) < margin;
}

double gain_limit(LoopModel model) noexcept {
    // Small gains are stable, or none is; the search then takes the first crossing.
    const auto stable_at = [&](double gain) {
        model.gain = gain;
        return is_stable(model);
    };
    const double most = 100.0 / model.period;
    double low = 1e-3 / model.period;
    if (!stable_at(low)) return 0.0;
    double high = low;
    while (high < most && stable_at(high)) {
        low = high;
        high *= 1.5;
    }
    for (int halving = 0; halving < 20; ++halving) {
        const double middle = 0.5 * (low + high);
        (stable_at(middle) ? low : high) = middle;
    }
    return low;
}

double ideal_gain_limit(double period, int delay, double hand_stiffness, double stiffness) noexcept {
    return 2.0 * std::sin(std::numbers::pi / (2.0 * (2.0 * delay + 1.0))) / (1.0 + hand_stiffness / stiffness) / period;
}

double gain_limit(const LoopModel& model, const ObjectSettings& object) noexcept {
    const double in_contact = gain_limit(with(model, object, true));
    return object.one_sided ? std::min(in_contact, gain_limit(with(model, object, false))) : in_contact;
}

}  // namespace tactus::control
