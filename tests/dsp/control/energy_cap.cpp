// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/energy_cap.hpp"

#include "dsp/core/random.hpp"
#include "tests/dsp/control/period.hpp"
#include "tests/support/bounce.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;
using test::Bounce;

namespace {

/// The largest ratio over the matrix, with and without the cap.
struct Ratios {
    double with = 0.0, without = 0.0;
};

Ratios over_bounces(Bounce bounce) {
    Ratios most;
    test::for_bounces([&](double mass, double stiffness, double speed) {
        bounce.mass = mass;
        bounce.stiffness = stiffness;
        bounce.speed = speed;
        bounce.capped = true;
        const double with = bounce.worst();
        INFO(mass << " kg, " << stiffness * 1e-3 << " N/mm, " << speed << " m/s");
        CHECK(with <= 1.10);
        most.with = std::max(most.with, with);
        bounce.capped = false;
        most.without = std::max(most.without, bounce.worst(4));
    });
    return most;
}

control::EnergyCap made(double resolution = 20e-6) {
    control::EnergyCap cap;
    control::EnergyCapSettings settings;
    settings.period_s = period;
    settings.resolution = resolution;
    cap.prepare(settings);
    return cap;
}

Pose at(double x) { return {{x, 0.0, 0.0}, {1, 0, 0, 0}}; }
Wrench along_x(double force) { return {{force, 0.0, 0.0}, {}}; }

/// A hand that follows x(t) against a spring beyond x = 0; the samples pass through `seen`. Returns the largest part of
/// the spring's force that the cap has taken, N.
template <class Motion, class Seen>
double max_taken(double stiffness, double seconds, double resolution, Motion&& motion, Seen&& seen) {
    control::EnergyCap cap = made(resolution);
    Wrench committed;
    double most = 0.0;
    for (int n = 0; n < static_cast<int>(seconds / period); ++n) {
        const double x = seen(motion(n * period), n);
        const Wrench wanted = along_x(x > 0.0 ? -stiffness * x : 0.0);
        committed = cap.tick(wanted, committed, at(x), period, 0.0, false);
        most = std::max(most, glm::length(wanted.force - committed.force));
    }
    return most;
}

double quantised(double x, double step) { return std::round(x / step) * step; }

}  // namespace

TEST_CASE(
    "bounces on a sampled spring behind a slew limit return at most 1.05 of the energy for encoder steps up to "
    "20 µm, and many times as much without the cap") {
    for (const double quantum : {0.0, 5e-6, 20e-6}) {
        const Ratios most = over_bounces({.quantum = quantum});
        INFO(quantum * 1e6 << " µm");
        CHECK(most.with <= 1.05);
        CHECK(most.without > 8.0);
    }
    // The spring alone, as fast as the device takes it.
    const Ratios fast = over_bounces({.quantum = 20e-6, .slew = 1e9});
    CHECK(fast.with <= 1.05);
    CHECK(fast.without > 1.4);
}

TEST_CASE("a device with steps of 55 µm, friction and a tick of delay returns at most 1.10 of the energy") {
    for (const double slew : {1000.0, 1e9}) {
        const Ratios most =
            over_bounces({.quantum = 55e-6, .delay = 1, .friction = 0.1, .max_force = 3.3, .slew = slew});
        CHECK(most.with <= 1.10);
        CHECK(most.without > 1.2);
    }
}

TEST_CASE("a wheel that answers after 8 ms returns at most 1.15 of the energy at every rate of its node") {
    for (const int ticks_per_ms : {1, 2, 4, 8}) {
        double with = 0.0, without = 0.0;
        for (const double speed : {0.2, 0.4, 0.6}) {
            Bounce bounce{.mass = 0.3,
                          .stiffness = 300.0,
                          .speed = speed,
                          .quantum = 34e-6,
                          .delay = 8 * ticks_per_ms,
                          .period = 1e-3 / ticks_per_ms};
            with = std::max(with, bounce.worst());
            bounce.capped = false;
            without = std::max(without, bounce.worst());
        }
        INFO(ticks_per_ms << " kHz");
        CHECK(with <= 1.15);
        CHECK(without > 1.5);
    }
}

TEST_CASE("skipped ticks return no more energy") {
    for (const double slew : {1000.0, 1e9}) {
        const Ratios most = over_bounces({.quantum = 20e-6, .slew = slew, .skip_every = 7});
        CHECK(most.with <= 1.05);
        CHECK(most.without > 2.5);
    }
}

TEST_CASE("a fault in the middle of a contact fades the force without throwing the hand out") {
    double with = 0.0, without = 0.0;
    for (const int tick : {3, 6, 10, 15}) {
        Bounce bounce{.mass = 0.1, .stiffness = 5e3, .quantum = 20e-6, .fault_at = tick};
        with = std::max(with, bounce.worst());
        bounce.capped = false;
        without = std::max(without, bounce.worst());
    }
    CHECK(with <= 1.05);
    CHECK(without > 1.2);
}

TEST_CASE("a torsion spring returns no more energy than the rotation has put in") {
    double with = 0.0, without = 0.0;
    for (const double inertia : {2e-4, 5e-4, 2e-3})
        for (const double stiffness : {1.0, 5.0, 20.0})
            for (const double speed : {2.0, 5.0}) {
                Bounce bounce{.mass = inertia,
                              .stiffness = stiffness,
                              .speed = speed,
                              .quantum = 2e-4,
                              .max_force = 0.5,
                              .slew = 50.0,
                              .is_torsion = true};
                with = std::max(with, bounce.worst());
                bounce.capped = false;
                without = std::max(without, bounce.worst(4));
            }
    CHECK(with <= 1.05);
    CHECK(without > 2.0);
}

TEST_CASE("a hand that rests on a spring feels the whole spring, whatever the encoder and the muscles do") {
    Random random{3};
    for (const double stiffness : {1e3, 12.8e3})
        for (const double step : {20e-6, 55e-6}) {
            INFO(stiffness << " N/m, " << step * 1e6 << " µm");
            // One minute pressed 0.7 mm deep, on the edge between two steps, each sample on one side or the other.
            const auto press = [](double t) { return 0.7e-3 * std::min(1.0, t / 0.3); };
            const auto flicker = [&](double x, int n) {
                return quantised(x, step) +
                       (n > 300 ? step * static_cast<double>(random.bits(static_cast<std::uint64_t>(n)) % 2) : 0.0);
            };
            CHECK(max_taken(stiffness, 60.0, step, press, flicker) == 0.0);
            // A trembling hand: 50 µm at 9 Hz.
            const auto tremble = [](double t) {
                return 0.7e-3 * std::min(1.0, t / 0.3) + 50e-6 * std::sin(2.0 * std::numbers::pi * 9.0 * t);
            };
            CHECK(max_taken(stiffness, 60.0, step, tremble, [&](double x, int) { return quantised(x, step); }) == 0.0);
        }
}

TEST_CASE("a slow press, withdrawal and second press follow the spring") {
    for (const double step : {20e-6, 55e-6}) {
        const auto motion = [](double t) {
            // In to 1 mm, out to 0.2 mm, four times, and out of the contact: 5 mm/s at most.
            const double depth = 0.6e-3 - 0.4e-3 * std::cos(2.0 * std::numbers::pi * t);
            return t < 1.0 ? 0.2e-3 * t - 0.1e-3 : t < 5.0 ? depth - 0.1e-3 : 0.1e-3 - 1e-3 * (t - 5.0);
        };
        const double taken = max_taken(2e3, 8.0, step, motion, [&](double x, int) { return quantised(x, step); });
        INFO(step * 1e6 << " µm");
        CHECK(taken <= 4.0 * 2e3 * step);
    }
}

TEST_CASE("energy that a contact has dissipated is forgotten when it ends") {
    control::EnergyCap cap = made();
    Wrench committed;
    double x = 0.0;
    // A stroke through a brake of 2 N puts 20 mJ in.
    for (int n = 0; n < 100; ++n) committed = cap.tick(along_x(-2.0), committed, at(x += 1e-4), period, 0.0, false);
    CHECK(cap.stored() > 0.015);
    committed = cap.tick({}, committed, at(x), period, 0.0, false);
    committed = cap.tick({}, committed, at(x), period, 0.0, false);
    CHECK(cap.stored() == 0.0);
}

TEST_CASE("a force that nobody put in is let through only as far as power is granted") {
    const auto given = [](double watts) {
        control::EnergyCap cap = made();
        Wrench committed;
        double x = 0.0, v = 0.0, joules = 0.0;
        for (int n = 0; n < 2000; ++n) {
            const Wrench out = cap.tick(along_x(8.0), committed, at(x), period, watts, false);
            // A hand of 0.3 kg that brakes with 20 N s/m.
            const double before = x;
            v += (out.force.x - 20.0 * v) / 0.3 * period;
            x += v * period;
            joules += out.force.x * (x - before);
            committed = out;
        }
        return joules;
    };
    CHECK(given(0.0) < 5e-3);
    CHECK(given(0.4) > 0.5);
    CHECK(given(0.4) < 0.85);
}

TEST_CASE("what faded in another thread puts nothing in") {
    control::EnergyCap cap = made();
    Wrench committed;
    double x = 0.0;
    for (int n = 0; n < 20; ++n) committed = cap.tick(along_x(-2.0), committed, at(x += 1e-4), period, 0.0, false);
    const double before = cap.stored();
    cap.tick(along_x(-2.0), committed, at(x += 1e-3), 0.01, 0.0, true);
    CHECK(cap.stored() == before);
    cap.tick(along_x(-2.0), committed, at(x -= 1e-3), 0.01, 0.0, true);
    CHECK(cap.stored() < before);
}

TEST_CASE("a pose beyond all measure neither breaks the force nor blinds the cap to what follows") {
    for (const double far : {50.0, 1e200, -1e300}) {
        control::EnergyCap cap = made();
        Wrench committed;
        for (int n = 0; n < 100; ++n) {
            committed = cap.tick(along_x(5.0), committed, at(n % 10 == 5 ? far : 0.0), period, 0.0, false);
            CHECK(is_finite(committed));
        }
        // A force that pushes a hand that flies: nothing was put in.
        double x = 0.0, given = 0.0;
        for (int n = 0; n < 200; ++n) {
            const double before = x;
            x += 2e-4;
            given += committed.force.x * (x - before);
            committed = cap.tick(along_x(5.0), committed, at(x), period, 0.0, false);
        }
        CHECK(given < 5e-3);
    }
}

TEST_CASE("granted power that is not used within 20 ms lapses") {
    control::EnergyCap cap;
    cap.prepare({.period_s = 0.001});
    const Wrench force{{0.0, 0.0, 9.0}, {}};
    constexpr double granted_W = 1.0;
    Pose hand;
    for (int n = 0; n < 1000; ++n) cap.tick(force, force, hand, 0.001, granted_W, false);
    // 9 N along 25 mm give 0.225 J in 50 ms.
    for (int n = 0; n < 50; ++n) {
        hand.position.z += 0.0005;
        cap.tick(force, force, hand, 0.001, granted_W, false);
    }
    CHECK(cap.statistics().granted <= granted_W * (0.02 + 0.05) * 1.001);
    CHECK(cap.statistics().granted >= granted_W * 0.02);
}
