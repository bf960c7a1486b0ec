// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/sampled_wall.hpp"

#include "dsp/control/adaptive_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::control {
namespace {

/// Forces on their way to the hand, by the step at which they act.
class DelayedForce {
public:
    explicit DelayedForce(int steps) : steps_(std::clamp(steps, 0, static_cast<int>(ring_.size()) - 1)) {}
    void set(double force) noexcept { now_ = force; }
    double step() noexcept {
        ring_[at_] = now_;
        const double out = ring_[(at_ + ring_.size() - static_cast<std::size_t>(steps_)) % ring_.size()];
        at_ = (at_ + 1) % ring_.size();
        return out;
    }

private:
    std::array<double, 1024> ring_{};
    std::size_t at_ = 0;
    int steps_;
    double now_ = 0.0;
};

/// How far a motion goes, and whether it returns: creep does not.
class Swing {
public:
    void add(double x) noexcept {
        if (!started_) first_ = last_ = low_ = high_ = x;
        started_ = true;
        low_ = std::min(low_, x);
        high_ = std::max(high_, x);
        path_ += std::abs(x - last_);
        last_ = x;
    }
    double extent() const noexcept { return high_ - low_; }
    bool returns() const noexcept { return path_ - std::abs(last_ - first_) > 0.5 * extent(); }

private:
    double first_ = 0.0, last_ = 0.0, low_ = 0.0, high_ = 0.0, path_ = 0.0;
    bool started_ = false;
};

/// Work of a held force −x, or −ẋ by the last difference, on a hand that moves straight between samples, and ∫ẋ² dt:
/// sums over whole waves.
struct Work {
    double by_position = 0.0, by_velocity = 0.0, squared_speed = 0.0;
};

Work along_wave(double angle, double phase, double period, double delay, int ticks) noexcept {
    const auto sample = [&](double n) { return std::sin(angle * n + phase); };
    const double late = delay / period, whole = std::floor(late), part = late - whole;
    // Where the hand is at n + part periods, on the line between two samples.
    const auto place = [&](double n) { return sample(n) * (1.0 - part) + sample(n + 1.0) * part; };
    Work work;
    for (int n = 0; n < ticks; ++n) {
        const double k = n, moved = place(k + 1.0) - place(k), seen = sample(k - whole),
                     speed = (seen - sample(k - whole - 1.0)) / period, step = sample(k + 1.0) - sample(k);
        work.by_position -= seen * moved;
        work.by_velocity -= speed * moved;
        work.squared_speed += step * step / period;
    }
    return work;
}

}  // namespace

double colgate_stiffness(const SampledWall& wall) noexcept {
    return std::max(0.0, (wall.viscous - std::abs(wall.damping)) / (0.5 * wall.period + wall.delay));
}

double friction_stiffness(const SampledWall& wall) noexcept {
    return wall.resolution > 0.0 ? 2.0 * wall.friction / wall.resolution : std::numeric_limits<double>::infinity();
}

double quiet_stiffness(const SampledWall& wall) noexcept {
    return std::min(colgate_stiffness(wall), friction_stiffness(wall));
}

double passive_stiffness(const SampledWall& wall) noexcept {
    constexpr int ticks = 256, phases = 8;
    double least = std::numeric_limits<double>::infinity();
    for (int wave = 1; wave <= ticks / 2; ++wave)
        for (int p = 0; p < phases; ++p) {
            const Work work = along_wave(2.0 * std::numbers::pi * wave / ticks, std::numbers::pi * (p + 0.5) / phases,
                                         wall.period, wall.delay, ticks);
            const double left = wall.viscous * work.squared_speed - wall.damping * work.by_velocity;
            if (left <= 0.0) return 0.0;
            if (work.by_position > 0.0) least = std::min(least, left / work.by_position);
        }
    return least;
}

bool oscillates(const SampledWall& wall) noexcept {
    constexpr double seconds = 2.0, window = 0.3;
    constexpr int steps = 8;
    const double farthest = 1.0 + 3.0 * wall.press / wall.stiffness;  // m
    const double h = wall.period / steps;
    DelayedForce force(static_cast<int>(std::lround(wall.delay / h)));
    AdaptiveWindow speed;
    speed.prepare(wall.resolution);
    double x = -0.1e-3, v = wall.approach;  // x > 0 is inside
    const double quiet = std::max(2.5 * wall.resolution, 2e-6);
    Swing before, last, now;
    const auto ticks = static_cast<int>(seconds / wall.period),
               ticks_in_window = std::max(1, static_cast<int>(window / wall.period));
    for (int n = 0; n < ticks; ++n) {
        const double seen = wall.resolution > 0.0 ? std::round(x / wall.resolution) * wall.resolution : x;
        const double velocity = speed({seen, 0.0, 0.0}, wall.period).x;
        const double push = seen > 0.0 ? std::max(0.0, wall.stiffness * seen + wall.damping * velocity) : 0.0;
        force.set(-std::min(push, wall.max_force));
        for (int i = 0; i < steps; ++i) {
            // The damper implicitly, Coulomb friction by what is left of the speed.
            const double free =
                (v + (force.step() + wall.press) / wall.mass * h) / (1.0 + wall.viscous / wall.mass * h);
            const double most = wall.friction / wall.mass * h;
            const double after = std::abs(free) <= most ? 0.0 : free - std::copysign(most, free);
            x += 0.5 * (v + after) * h;
            v = after;
        }
        const double t = n * wall.period;
        if (t >= seconds - 1.0 - window && t < seconds - 1.0) before.add(x);
        if (t >= seconds - window) last.add(x);
        if (!std::isfinite(x) || std::abs(x) > farthest) return true;
        // A wall that is unstable leaves no hand in such a rest.
        now.add(x);
        if ((n + 1) % ticks_in_window == 0) {
            if (now.extent() < 0.1 * quiet) return false;
            now = {};
        }
    }
    return last.extent() > quiet && last.returns() && last.extent() > 0.7 * before.extent();
}

SimulatedLimit simulated_stiffness(SampledWall wall, double max) noexcept {
    constexpr int presses = 6;
    constexpr double lightest = 0.5, assumed_force = 10.0, softest = 50.0;
    const double firmest = std::max(lightest, 0.8 * (wall.max_force < 1e6 ? wall.max_force : assumed_force));
    // The first stiffness that oscillates, in steps of a quarter and then of 4 %: there may be quiet islands beyond it.
    const auto first = [&](double from, double step, double end) {
        for (wall.stiffness = from; wall.stiffness < end; wall.stiffness *= step)
            if (oscillates(wall)) break;
        return std::min(wall.stiffness, end);
    };
    SimulatedLimit worst{max, 0.0, 0.0};
    for (int i = presses - 1; i >= 0; --i)
        for (const double approach : {0.3, 0.1, 0.02}) {
            wall.press = lightest * std::pow(firmest / lightest, i / (presses - 1.0));
            wall.approach = approach;
            const double rough = first(softest, 1.25, worst.stiffness);
            if (rough >= worst.stiffness) continue;
            worst = {first(rough / 1.25, 1.04, rough), wall.press, approach};
        }
    return worst;
}

}  // namespace tactus::control
