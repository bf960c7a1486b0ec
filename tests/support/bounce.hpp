// SPDX-License-Identifier: Apache-2.0
// A mass that flies into a sampled spring, through the limiter and the energy cap as `device_output` chains them.
#pragma once

#include "dsp/control/energy_cap.hpp"
#include "dsp/control/force_limiter.hpp"
#include "dsp/core/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>

namespace tactus::test {

struct Bounce {
    double mass = 0.3, stiffness = 12.8e3, speed = 0.2;  ///< kg, N/m, m/s; of a torsion spring kg·m², N·m/rad, rad/s
    double quantum = 0.0;         ///< m or rad
    int delay = 0;                ///< whole ticks until a force acts
    double friction = 0.0;        ///< N
    double max_force = 10.0;      ///< N or N·m
    double slew = 1000.0;         ///< N/s or N·m/s
    double phase = 0.0;           ///< 0 to 1: where between two samples and two encoder steps the contact begins
    bool capped = true;
    bool is_torsion = false;
    int skip_every = 0;  ///< every so many ticks two are skipped; 0: never
    int fault_at = -1;  ///< tick of contact at which a fault starts the fade
    double period = 1e-3;

    /// Kinetic energy after the bounce over that before.
    double ratio() const {
        control::ForceLimiter limiter;
        control::ForceLimits limits;
        limits.max_force = limits.max_torque = max_force;
        limits.force_slew = limits.torque_slew = slew;
        limiter.prepare(limits, period);
        control::EnergyCap cap;
        control::EnergyCapSettings settings;
        settings.period_s = period;
        settings.delay_s = delay * period;
        if (quantum > 0.0) (is_torsion ? settings.angular_resolution : settings.resolution) = quantum;
        cap.prepare(settings);
        std::int64_t count = 0;
        while (count < 300) limiter.tick({}, ++count, true, period);

        // x > 0 is inside.
        double x = -speed * period * (10.0 + phase), v = speed, elapsed = period;
        Wrench committed;
        std::array<double, 65> under_way{};
        int touching = 0, apart = 0;
        for (int n = 0; n < 100000; ++n) {
            const double offset = phase * quantum;
            const double seen = quantum > 0.0 ? std::round((x + offset) / quantum) * quantum - offset : x;
            const double push = seen > 0.0 ? -stiffness * seen : 0.0;
            touching += push < 0.0;
            const Wrench wanted = is_torsion ? Wrench{{}, {0.0, 0.0, push}} : Wrench{{push, 0.0, 0.0}, {}};
            if (fault_at >= 0 && touching == fault_at) limiter.fail(control::Fault::sound_lost);
            limiter.start_from(committed);
            Wrench out = limiter.tick(wanted, ++count, true, elapsed);
            const Pose hand =
                is_torsion ? Pose{{}, rotation_by({0.0, 0.0, seen})} : Pose{{seen, 0.0, 0.0}, {1, 0, 0, 0}};
            if (capped) out = cap.tick(out, committed, hand, elapsed, 0.0, false);
            committed = out;

            const int ticks = skip_every > 0 && n % skip_every == 3 ? 3 : 1;
            for (int t = 0; t < ticks; ++t) {
                std::shift_right(under_way.begin(), under_way.end(), 1);
                under_way[0] = is_torsion ? committed.torque.z : committed.force.x;
                fly(x, v, under_way[static_cast<std::size_t>(delay)]);
            }
            elapsed = ticks * period;
            const auto coming = std::span(under_way).first(static_cast<std::size_t>(std::max(delay + 1, 9)));
            const bool is_free = x < 0.0 && std::ranges::all_of(coming, [](double f) { return f == 0.0; });
            apart = touching > 0 && is_free ? apart + 1 : 0;
            if (apart > 3 || (touching > 0 && v == 0.0 && is_free)) break;
        }
        return v * v / (speed * speed);
    }

    /// The largest ratio for contacts that begin at different places between samples and steps.
    double worst(int phases = 12) const {
        double most = 0.0;
        for (int i = 0; i < phases; ++i) {
            Bounce one = *this;
            one.phase = std::fmod(i * 0.6180339887, 1.0);
            most = std::max(most, one.ratio());
        }
        return most;
    }

private:
    /// One tick under a held force, with Coulomb friction outside and inside of the contact alike.
    void fly(double& x, double& v, double force) const {
        const int steps = friction > 0.0 ? 10 : 1;
        const double h = period / steps;
        for (int i = 0; i < steps; ++i) {
            const double free = v + force / mass * h, most = friction / mass * h;
            const double after = std::abs(free) <= most ? 0.0 : free - std::copysign(most, free);
            x += 0.5 * (v + after) * h;
            v = after;
        }
    }
};

/// Masses, stiffnesses and speeds at which a contact is judged.
inline void for_bounces(const std::function<void(double mass, double stiffness, double speed)>& call) {
    for (const double mass : {0.1, 0.3, 1.0})
        for (const double stiffness : {1e3, 2.5e3, 5e3, 12.8e3})
            for (const double speed : {0.2, 0.4, 0.6}) call(mass, stiffness, speed);
}

}  // namespace tactus::test
