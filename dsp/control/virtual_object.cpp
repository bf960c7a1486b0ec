// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/virtual_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::control {

namespace {

using Square = std::array<std::array<double, 3>, 3>;

Square product(const Square& a, const Square& b) noexcept {
    Square c{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// e^A by scaling and squaring; the series is exact to the last bit for norms up to 1/2, which the scaling ensures.
Square exponential(Square a) noexcept {
    double norm = 0.0;
    for (const auto& row : a)
        for (const double v : row) norm = std::max(norm, std::abs(v));
    const int halvings = norm > 0.125 ? std::min(static_cast<int>(std::ceil(std::log2(norm / 0.125))), 60) : 0;
    for (auto& row : a)
        for (double& v : row) v = std::ldexp(v, -halvings);
    Square sum{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, term = sum;
    for (int n = 1; n < 16; ++n) {
        term = product(term, a);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) sum[i][j] += term[i][j] /= n;
    }
    for (int n = 0; n < halvings; ++n) sum = product(sum, sum);
    return sum;
}

}  // namespace

bool ObjectSettings::is_renderable() const noexcept {
    if (one_sided && !(free_damping > 0.0)) return false;
    if (kind == ObjectKind::elastic) return stiffness > 0.0 || damping > 0.0 || mass > 0.0;
    return kind == ObjectKind::wall || table != nullptr;
}

HeldStep held_step(double k, double b, double m, double dt) noexcept {
    HeldStep s;
    if (m > 0.0) {
        const Square e = exponential({{{0.0, dt, 0.0}, {-k / m * dt, -b / m * dt, dt / m}, {0.0, 0.0, 0.0}}});
        s = {e[0][0], e[0][1], e[0][2], e[1][0], e[1][1], e[1][2]};
    } else if (k > 0.0) {
        const double a = b > 0.0 ? std::exp(-k * dt / b) : 0.0;
        s.xx = a;
        s.xf = (b > 0.0 ? -std::expm1(-k * dt / b) : 1.0) / k;
        s.vv = 0.0;
    } else {
        s.xf = dt / b;
        s.vv = 0.0;
    }
    return s;
}

void VirtualObject::set(const ObjectSettings& settings, double period_s) noexcept {
    const double position = this->position();
    settings_ = settings;
    dt_ = period_s;
    x_ = position - settings.rest;
    if (!(settings.mass > 0.0)) v_ = 0.0;
    contact_ = held_step(settings.stiffness, settings.damping, settings.mass, period_s);
    free_ = held_step(0.0, settings.free_damping, settings.mass, period_s);
}

void VirtualObject::place(double position) noexcept {
    x_ = position - settings_.rest;
    v_ = 0.0;
}

double VirtualObject::step(double force) noexcept {
    const bool wall = settings_.kind == ObjectKind::wall;
    if (settings_.kind == ObjectKind::table) {
        x_ = settings_.table->follow(x_, force);
    } else if (wall && !settings_.one_sided) {
        place(settings_.rest);
    } else if (settings_.mass > 0.0) {
        const HeldStep& s = settings_.one_sided && (x_ < 0.0 || wall) ? free_ : contact_;
        const double x = s.xx * x_ + s.xv * v_ + s.xf * force;
        v_ = s.vx * x_ + s.vv * v_ + s.vf * force;
        x_ = x;
    } else if (!settings_.one_sided) {
        x_ = contact_.xx * x_ + contact_.xf * force;
    } else {
        step_massless(force);
    }
    if (wall && x_ > 0.0) place(settings_.rest);
    return position();
}

void VirtualObject::step_massless(double force) noexcept {
    if (settings_.kind == ObjectKind::wall) {
        x_ = std::min(0.0, x_ + free_.xf * force);
        return;
    }
    double left = dt_;
    if (x_ < 0.0) {
        const double until_met = force > 0.0 ? -x_ * settings_.free_damping / force : dt_;
        if (until_met >= dt_) {
            x_ += free_.xf * force;
            return;
        }
        x_ = 0.0;
        left -= until_met;
    }
    x_ = leave_or_press(force, left);
}

/// From x ≥ 0 for `left` s: b ẋ + k x = F until x = 0; from there a pull moves the free finger.
double VirtualObject::leave_or_press(double force, double left) noexcept {
    const double k = settings_.stiffness, b = settings_.damping;
    double until_free = 0.0;  // without damping the object follows at once
    if (b > 0.0 && k > 0.0) {
        const double end = force / k;
        if (force < 0.0) until_free = b / k * std::log1p(-x_ / end);
        if (force >= 0.0 || until_free >= left) return end + (x_ - end) * std::exp(-k * left / b);
    } else if (b > 0.0) {
        if (force < 0.0) until_free = -x_ * b / force;
        if (force >= 0.0 || until_free >= left) return x_ + force * left / b;
    } else if (force >= 0.0) {
        return k > 0.0 ? force / k : 0.0;
    }
    return force * (left - until_free) / settings_.free_damping;
}

}  // namespace tactus::control
