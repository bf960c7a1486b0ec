// SPDX-License-Identifier: Apache-2.0
// Two hands on one spring, each behind an energy cap of its own.
#include "dsp/coupling/shared_energy.hpp"

#include "dsp/control/energy_cap.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

struct Led {
    double mean_force = 0.0, max_force = 0.0, largest_step = 0.0;  ///< N, on the led hand
    double given = 0.0, taken = 0.0;  ///< J: net work on the led hand, and of the leading hand on the spring
};

/// One hand moves 60 mm to and fro; the other one, of 0.2 kg against a damper of its owner, follows on the spring.
Led lead(double stiffness, bool is_granted, double period = 1e-3, double damper = 5.0) {
    control::EnergyCapSettings settings;
    settings.period_s = period;
    control::EnergyCap caps[2];
    for (control::EnergyCap& cap : caps) cap.prepare(settings);
    coupling::SharedEnergy shared;
    double x[2]{}, v = 0.0;
    Wrench held[2];
    coupling::SharedEnergy::Grants grants{};
    Led led;
    const int ticks = static_cast<int>(8.0 / period);
    for (int n = 0; n < ticks; ++n) {
        const double t = n * period;
        x[0] = 0.03 * (1.0 - std::cos(2.0 * std::numbers::pi * t)) * std::min(1.0, t);
        const double force = stiffness * (x[1] - x[0]);
        std::array<coupling::SharedEnergy::Hand, 2> hands;
        for (int i = 0; i < 2; ++i) {
            const double seen = std::round(x[i] / 20e-6) * 20e-6;
            hands[static_cast<std::size_t>(i)] = {{{seen, 0.0, 0.0}, {1, 0, 0, 0}},
                                                  {{i == 0 ? force : -force, 0.0, 0.0}, {}}};
        }
        grants = shared.tick(hands, 0.5 * force * force / stiffness, period);
        for (std::size_t i = 0; i < 2; ++i) {
            const Wrench before = held[i];
            held[i] =
                caps[i].tick(hands[i].wrench, held[i], hands[i].pose, period, is_granted ? grants[i] : 0.0, false);
            if (i == 1) led.largest_step = std::max(led.largest_step, std::abs(held[i].force.x - before.force.x));
        }
        const double on_led = held[1].force.x, x0 = x[1];
        for (int i = 0; i < 20; ++i) {
            v += (on_led - damper * v) / 0.2 * period / 20.0;
            x[1] += v * period / 20.0;
        }
        const double next = 0.03 * (1.0 - std::cos(2.0 * std::numbers::pi * (t + period))) * std::min(1.0, t + period);
        led.given += on_led * (x[1] - x0);
        led.taken -= held[0].force.x * (next - x[0]);
        if (t > 1.0) led.mean_force += std::abs(on_led) / (7.0 / period);
        led.max_force = std::max(led.max_force, std::abs(on_led));
    }
    return led;
}

}  // namespace

TEST_CASE("a hand that another one leads through a declared coupling feels its force, smoothly") {
    for (const double stiffness : {300.0, 1000.0, 2000.0}) {
        const Led alone = lead(stiffness, false), granted = lead(stiffness, true);
        INFO(stiffness << " N/m: mean " << alone.mean_force << " and " << granted.mean_force << " N, most "
                       << alone.max_force << " and " << granted.max_force << " N");
        // The damper alone: 5 N s/m at 0.12 m/s in the mean, 0.19 m/s at most.
        CHECK(granted.mean_force == Approx(0.6).epsilon(0.1));
        CHECK(granted.max_force < 1.3);
        CHECK(alone.mean_force < 0.6 * granted.mean_force);
    }
}

TEST_CASE("a declared coupling gives one hand no more than the other has put in") {
    for (const double period : {1e-3, 0.25e-3, 1.0 / 250.0})
        for (const double stiffness : {100.0, 300.0, 1000.0})
            for (const double damper : {2.0, 5.0, 10.0}) {
                const Led led = lead(stiffness, true, period, damper);
                INFO(1.0 / period << " Hz, " << stiffness << " N/m, " << damper << " N s/m: " << led.given << " J of "
                                  << led.taken);
                CHECK(led.given <= 1.05 * led.taken + 3e-3);
                CHECK(led.given > 0.0);
            }
}

TEST_CASE("a force that neither hand has put in is granted to none") {
    coupling::SharedEnergy shared;
    // Both hands are pushed apart by a force that appears while they rest, and move along it.
    double most = 0.0;
    for (int n = 0; n < 2000; ++n) {
        const double x = 1e-4 * n;
        const auto grants = shared.tick(
            {{{{{x, 0, 0}, {1, 0, 0, 0}}, {{5, 0, 0}, {}}}, {{{-x, 0, 0}, {1, 0, 0, 0}}, {{-5, 0, 0}, {}}}}}, 1.0,
            1e-3);
        most = std::max({most, grants[0], grants[1]});
    }
    CHECK(most == 0.0);
}

TEST_CASE("a pose that is none ends the account of a coupling") {
    coupling::SharedEnergy shared;
    const Pose here{{}, {1, 0, 0, 0}}, there{{0.01, 0, 0}, {1, 0, 0, 0}}, none{{}, {0, 0, 0, 0}};
    const Wrench pull{{-10, 0, 0}, {}};
    shared.tick({{{here, pull}, {here, {}}}}, 1.0, 1e-3);
    shared.tick({{{there, pull}, {here, {}}}}, 1.0, 1e-3);
    CHECK(shared.energy() == Approx(0.1));
    const auto grants = shared.tick({{{none, pull}, {here, {}}}}, 1.0, 1e-3);
    CHECK(grants[0] == 0.0);
    CHECK(shared.energy() == 0.0);
}
