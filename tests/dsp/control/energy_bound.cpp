// SPDX-License-Identifier: Apache-2.0
// The energy cap against the bound that it states, at every rate, delay and stiffness.
#include "dsp/control/energy_cap.hpp"
#include "dsp/control/force_limiter.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace tactus;

namespace {

/// A free mass that flies into a sampled spring, through limiter and cap. Between ticks it moves under the held force.
struct Flight {
    double rate = 1000.0;       ///< Hz
    double stiffness = 1000.0;  ///< N/m
    double mass = 0.1;          ///< kg
    double speed = 0.2;         ///< m/s
    double phase = 0.0;         ///< 0 to 1, between two samples
    double step = 20e-6;        ///< m, of the samples
    double delay = 0.0;         ///< s
    int late = 0;               ///< ticks by which a contact group of its own is late
    double slew = 1000.0;       ///< N/s
    double max_force = 10.0;    ///< N
    bool capped = true;

    control::EnergyCapSettings settings() const {
        control::EnergyCapSettings settings;
        settings.period_s = 1.0 / rate;
        settings.delay_s = delay;
        settings.resolution = step;
        return settings;
    }

    /// Largest work of the force on the mass since the start, without what a hand of 2 N·s/m would have damped by then, J.
    double gain() const {
        const double period = 1.0 / rate;
        control::ForceLimiter limiter;
        control::ForceLimits limits;
        limits.max_force = max_force;
        limits.force_slew = slew;
        limiter.prepare(limits, period);
        control::EnergyCap cap;
        cap.prepare(settings());
        std::int64_t count = 0;
        while (count < static_cast<std::int64_t>(0.5 * rate) + 10) limiter.tick({}, ++count, true, period);
        const int steps = std::max(20, static_cast<int>(period / 5e-5));
        const double h = period / steps;
        std::vector<double> under_way(static_cast<std::size_t>(std::lround(delay / h)) + 1, 0.0);
        std::size_t at = 0;
        double x = -speed * period * (3.0 + phase) - 1e-4, v = speed, work = 0.0, most = 0.0,
               damped = 0.0;  // x > 0 is inside
        std::vector<double> seen(static_cast<std::size_t>(late) + 1, x);
        Wrench committed;
        bool touched = false;
        double apart = 0.0;
        for (int n = 0; n < 4000 && apart <= 3.0 + delay * rate + late; ++n) {
            const double sample = std::round(x / step) * step;
            std::shift_right(seen.begin(), seen.end(), 1);
            seen.front() = sample;
            const double push = seen.back() > 0.0 ? -stiffness * seen.back() : 0.0;
            limiter.start_from(committed);
            Wrench out = limiter.tick({{push, 0.0, 0.0}, {}}, ++count, true, period);
            if (capped) out = cap.tick(out, committed, {{sample, 0.0, 0.0}, {1, 0, 0, 0}}, period, 0.0, false);
            committed = out;
            for (int i = 0; i < steps; ++i) {
                under_way[at] = out.force.x;
                at = (at + 1) % under_way.size();
                const double force = under_way[at], moved = v * h + 0.5 * force / mass * h * h;
                work += force * moved;
                if (std::abs(v) < 2.0 * control::EnergyCap::calm_m_s)
                    damped += control::StatedHand::damping * v * v * h;
                x += moved;
                v += force / mass * h;
            }
            most = std::max(most, work - damped);
            touched = touched || push < 0.0;
            apart = touched && x < 0.0 && out.force.x == 0.0 ? apart + 1.0 : 0.0;
        }
        return most;
    }

    /// Of what `max_gain` permits.
    double excess(double known_stiffness) const {
        return gain() - 0.05 * 0.5 * mass * speed * speed -
               control::EnergyCap::max_gain(settings(), known_stiffness, max_force);
    }
};

double pick(std::initializer_list<double> from, double uniform) {
    return *(from.begin() + static_cast<std::ptrdiff_t>(uniform * static_cast<double>(from.size())));
}

}  // namespace

TEST_CASE("the energy cap keeps its bound at every rate, delay, stiffness, mass and speed") {
    const Random random{39};
    double uncapped = -1.0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        std::uint64_t draw = 16 * i;
        const auto next = [&] { return random.uniform(draw++); };
        const auto between = [&](double low, double high) { return low * std::pow(high / low, next()); };
        Flight flight;
        flight.rate = next() < 0.5 ? pick({60.0, 150.0, 250.0, 500.0, 1000.0, 4000.0}, next()) : between(50.0, 8000.0);
        flight.stiffness = between(50.0, 20e3);
        flight.mass = between(0.1, 1.0);
        flight.speed = between(0.01, 1.0);
        flight.phase = next();
        flight.step = pick({1e-6, 20e-6, 55e-6}, next());
        flight.delay = std::min(pick({0.0, 0.5e-3, 1e-3, 4e-3, 8e-3}, next()), 60.0 / flight.rate);
        flight.late = static_cast<int>(3.0 * next());
        flight.slew = next() < 0.5 ? 1000.0 : 1e9;
        flight.max_force = pick({3.3, 10.0, 20.0}, next());
        INFO(i << ": " << flight.rate << " Hz, " << flight.stiffness << " N/m, " << flight.mass << " kg, "
               << flight.speed << " m/s, " << flight.step * 1e6 << " µm, " << flight.delay * 1e3 << " ms, "
               << flight.late << " ticks late, " << flight.max_force << " N, slew " << flight.slew);
        const double excess = flight.excess(flight.stiffness);
        if (excess > 0.0) CHECK(excess * 1e3 <= 0.0);
        flight.capped = false;
        if (i % 20 == 0) uncapped = std::max(uncapped, flight.excess(flight.stiffness));
    }
    CHECK(uncapped > 0.1);
}

TEST_CASE("at 60 Hz a hand of 0.1 kg leaves with no more than a millijoule that it did not bring") {
    for (const double stiffness : {180.0, 1000.0, 5000.0})
        for (const double speed : {0.01, 0.05, 0.2, 0.5})
            for (const int late : {0, 1, 2})
                for (double phase = 0.0; phase < 1.0; phase += 0.1) {
                    Flight flight{.rate = 60.0, .stiffness = stiffness, .speed = speed, .phase = phase, .late = late};
                    INFO(stiffness << " N/m, " << speed << " m/s, phase " << phase << ", late " << late);
                    CHECK(flight.gain() <= 0.05 * 0.5 * 0.1 * speed * speed + 1.7e-3);
                }
}

TEST_CASE("the bound of the energy cap falls with the rate, and rises with delay and stiffness") {
    const auto bound = [](double rate, double delay, double stiffness) {
        return control::EnergyCap::max_gain(Flight{.rate = rate, .delay = delay}.settings(), stiffness, 10.0);
    };
    CHECK(bound(4000.0, 0.0, 1000.0) < bound(1000.0, 0.0, 1000.0));
    CHECK(bound(1000.0, 0.0, 1000.0) < bound(1000.0, 1e-3, 1000.0));
    CHECK(bound(1000.0, 1e-3, 1000.0) < bound(1000.0, 1e-3, std::numeric_limits<double>::infinity()) + 1e-12);
    CHECK(bound(1000.0, 1e-3, 100.0) < bound(1000.0, 1e-3, 1000.0));
    CHECK(bound(60.0, 0.0, 240.0) < 2e-3);
}

TEST_CASE("at 60 Hz a hand that leans on a spring of 0.18 N/mm feels all of it") {
    for (const double press : {1.0, 3.0, 5.0}) {
        control::EnergyCap cap;
        cap.prepare(Flight{.rate = 60.0}.settings());
        Wrench committed;
        double least = 1.0;
        for (int n = 0; n < 1200; ++n) {
            const double x = press / 180.0 * std::min(1.0, n / 300.0);  // over 5 s
            const Wrench wanted{{-180.0 * x, 0.0, 0.0}, {}};
            committed = cap.tick(wanted, committed, {{x, 0.0, 0.0}, {1, 0, 0, 0}}, 1.0 / 60.0, 0.0, false);
            if (n > 300) least = std::min(least, committed.force.x / wanted.force.x);
        }
        INFO(press << " N");
        CHECK(least > 0.97);
    }
}
