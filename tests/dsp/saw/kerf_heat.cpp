// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/kerf_heat.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/saw/heat_partition.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;
using saw::KerfHeat;
using saw::KerfMaterial;

namespace {

/// A line that removes nothing.
KerfMaterial line() {
    KerfMaterial material;
    material.kerf = 0.0;
    return material;
}

}  // namespace

TEST_CASE("around a line source at rest the temperature is the exponential integral") {
    // T = q / (4 π k) E1(r² / (4 α t)) for q W per metre; E1(x) = -Ei(-x).
    const KerfMaterial material = line();
    KerfHeat heat(material);
    const double q = 100.0, seconds = 8.0;
    heat.advance(1e-9, 20e-3, 0.0, false);
    for (int i = 0; i < 480; ++i) heat.advance(seconds / 480.0, 20e-3, q, false);
    for (const double r : {1e-3, 1.5e-3, 2.5e-3, 4e-3}) {
        const double expected =
            q / (4.0 * pi * material.conductivity) * -std::expint(-r * r / (4.0 * material.diffusivity() * seconds));
        CHECK(heat.at(20e-3, r) == Approx(expected).epsilon(0.05));
        CHECK(heat.at(20e-3 + r, 0.0) == Approx(expected).epsilon(0.05));
        CHECK(heat.at(20e-3 - r, 0.0) == Approx(expected).epsilon(0.05));
    }
}

TEST_CASE("a moving line source has the temperature of Jaeger's solution ahead, behind and beside it") {
    // Steady: T = q / (2 π k) exp(-v x / (2 α)) K0(v r / (2 α)), x ahead of the source.
    const KerfMaterial material = line();
    for (const double speed : {0.67e-3, 1.5e-3}) {
        KerfHeat heat(material);
        const double q = 150.0, end = 40e-3;
        const double tick = 1.0 / 60.0;
        double depth = 0.0;
        while (depth < end) heat.advance(tick, depth += speed * tick, q, false);
        const double half = speed / (2.0 * material.diffusivity());
        const auto jaeger = [&](double x, double y) {
            return q / (2.0 * pi * material.conductivity) * std::exp(-half * x) *
                   std::cyl_bessel_k(0.0, half * std::hypot(x, y));
        };
        CAPTURE(speed);
        for (const double x : {0.75e-3, -1e-3, -2e-3})
            for (const double y : {0.125e-3, 0.6e-3, 1.1e-3, 1.6e-3}) {
                CAPTURE(x, y);
                CHECK(heat.at(depth + x, y) == Approx(jaeger(x, y)).epsilon(0.06).margin(0.7));
            }
    }
}

TEST_CASE("before a wide floor that is cut away the temperature is that of a plane that moves with the source") {
    // Steady, in one dimension: T = q / (ρ c v) exp(-v x / α), x ahead of the floor, q W/m²: what is removed takes all heat.
    KerfMaterial material;
    material.kerf = 2.0 * 31.0 * KerfHeat::cell;
    for (const double speed : {0.3e-3, 0.67e-3}) {
        KerfHeat heat(material);
        const double q = 20e3, tick = 1.0 / 60.0;
        double depth = 0.0;
        while (depth < 12e-3) heat.advance(tick, depth += speed * tick, q * material.kerf, false);
        const double carried = heat.carried();
        // The mean over 20 rows: where in its row the floor is makes a ripple.
        const int ticks = static_cast<int>(20.0 * KerfHeat::cell / (speed * tick));
        double mean = 0.0;
        for (int i = 0; i < ticks; ++i) {
            heat.advance(tick, depth += speed * tick, q * material.kerf, false);
            mean += heat.at(depth + 0.5e-3, 0.0) / ticks;
        }
        const double floor = q / (material.density * material.heat_capacity * speed);
        CAPTURE(speed, floor, mean);
        CHECK(mean == Approx(floor * std::exp(-speed * 0.5e-3 / material.diffusivity())).epsilon(0.08));
        // One row of twenty is on its way, and some heat leaves at the edge of the grid.
        CHECK(heat.carried() - carried == Approx(q * material.kerf * ticks * tick).epsilon(0.1));
    }
}

TEST_CASE("a wet wide floor has the temperature at which water and bone take the heat") {
    // At rest for long, one dimension: all heat goes into the water, q = transfer·(T - coolant) at the surface.
    KerfMaterial material;
    material.kerf = 2.0 * 31.0 * KerfHeat::cell;
    material.coolant = 0.0;
    const double q = 20e3, speed = 0.5e-3, tick = 1.0 / 60.0;
    KerfHeat heat(material);
    double depth = 0.0, mean = 0.0;
    while (depth < 12e-3) heat.advance(tick, depth += speed * tick, q * material.kerf, true);
    const int ticks = static_cast<int>(20.0 * KerfHeat::cell / (speed * tick));
    for (int i = 0; i < ticks; ++i) {
        heat.advance(tick, depth += speed * tick, q * material.kerf, true);
        mean += heat.at(depth + 0.5e-3, 0.0) / ticks;
    }
    // Moving: what is removed takes ρ c v T of the floor along, the water the rest.
    const double floor = q / (material.transfer + material.density * material.heat_capacity * speed);
    CAPTURE(floor, mean);
    // The wet surface is that of a row, half a row behind the teeth on average.
    const double ahead = 0.5e-3 + 0.5 * KerfHeat::cell;
    CHECK(mean == Approx(floor * std::exp(-speed * ahead / material.diffusivity())).epsilon(0.2));
}

TEST_CASE("the bone holds the heat that was given less what the chips took") {
    KerfHeat heat;
    double given = 0.0, depth = 0.0;
    while (depth < 4e-3) {
        heat.advance(0.01, depth += 0.5e-5, 100.0, false);
        given += 0.01 * 100.0;
    }
    CHECK(heat.carried() > 0.05 * given);
    CHECK(heat.content() + heat.carried() == Approx(given).epsilon(2e-3));
}

TEST_CASE("without irrigation no heat is lost") {
    KerfHeat heat(line());
    double given = 0.0;
    for (int i = 0; i < 600; ++i) {
        const double q = i % 100 < 60 ? 80.0 : 0.0;
        heat.advance(0.02, 1e-5 * i, q, false);
        given += 0.02 * q;
    }
    CHECK(heat.content() == Approx(given).epsilon(1e-3));
}

TEST_CASE("irrigation cools the kerf, and never below its water") {
    KerfHeat dry_cut, wet_cut;
    for (int i = 0; i < 1200; ++i) {
        dry_cut.advance(1.0 / 60.0, 0.67e-3 * i / 60.0, 150.0, false);
        wet_cut.advance(1.0 / 60.0, 0.67e-3 * i / 60.0, 150.0, true);
    }
    CHECK(wet_cut.hottest() < dry_cut.hottest());
    CHECK(wet_cut.longest_above() < 0.5 * dry_cut.longest_above());
    CHECK(wet_cut.reach() <= dry_cut.reach());
    for (double depth = 0.0; depth < 12e-3; depth += 0.5e-3) {
        CHECK(wet_cut.at(depth, 0.2e-3) < dry_cut.at(depth, 0.2e-3));
        CHECK(wet_cut.at(depth, 0.2e-3) > KerfMaterial{}.coolant);
    }
    for (int i = 0; i < 6000; ++i) wet_cut.advance(0.05, 13e-3, 0.0, true);
    CHECK(wet_cut.hottest() < 1.0);
    CHECK(wet_cut.at(5e-3, 0.0) == Approx(KerfMaterial{}.coolant).margin(4.0));
}

TEST_CASE("the share of the heat that enters the bone is Weiner's") {
    const double alpha = KerfMaterial{}.diffusivity();
    const auto share = [&](double y) { return saw::share_into_bone(4.0 * y * alpha, 1.0, 1.0, alpha); };
    // By quadrature of Weiner's integral over the shear plane, 1 - (1/L)∫ of the part that the chip takes.
    for (const double y : {0.01, 0.1, 0.5, 2.0, 10.0, 24.0, 26.0, 100.0}) {
        const double root = std::sqrt(y);
        const double exact = y < 25.0 ? std::erf(root) / (4.0 * y) + (1.0 + y) * std::erfc(root) -
                                            std::exp(-y) / std::sqrt(pi) * (0.5 / root + root)
                                      : 1.0 / (4.0 * y);
        CHECK(share(y) == Approx(exact).epsilon(0.01));
    }
    CHECK(share(0.0) == 1.0);
    CHECK(share(1e-7) == Approx(1.0).margin(1e-3));
    double last = 1.0;
    for (double y = 0.001; y < 200.0; y *= 1.3) {
        CHECK(share(y) < last);
        last = share(y);
    }
}

TEST_CASE("a slower feed warms the wall more, and water takes most of it") {
    // The study of 15 states: the least warming is that of the least rate and the greatest feed.
    const saw::CuttingLaw law;
    const auto wall = [&](double rate, double feed, bool wet) {
        const double share = saw::share_into_bone(3e-3, feed, saw::tangent_of_shear(law), KerfMaterial{}.diffusivity());
        KerfHeat heat;
        double most = 0.0;
        for (double depth = 0.0; depth < 12e-3; depth += feed * 0.02) {
            heat.advance(0.02, depth, share * 2.0 * rate * law.along(law.thrust(feed / (2.0 * rate))), wet);
            most = std::max(most, heat.at(6e-3, 0.5e-3));
        }
        return most;
    };
    const double slow = 10e-3 / 60.0, fast = 30e-3 / 60.0;
    CAPTURE(wall(10e3 / 60.0, slow, false), wall(10e3 / 60.0, fast, false), wall(18e3 / 60.0, fast, false),
            wall(18e3 / 60.0, 20e-3 / 60.0, true));
    CHECK(wall(10e3 / 60.0, slow, false) > wall(10e3 / 60.0, fast, false));
    CHECK(wall(18e3 / 60.0, fast, false) > wall(10e3 / 60.0, fast, false));
    CHECK(wall(18e3 / 60.0, 20e-3 / 60.0, true) < 0.5 * wall(18e3 / 60.0, 20e-3 / 60.0, false));
}

TEST_CASE("the time above the limit is that of the place which was longest above it") {
    KerfHeat heat(line());
    heat.limit = 10.0;
    // A source at rest, until the cell beside it is hot; then it stops.
    double hot = 0.0;
    for (int i = 0; i < 3000; ++i) {
        heat.advance(0.01, 1e-9, i < 1000 ? 100.0 : 0.0, false);
        hot += heat.at(0.0, 0.125e-3) > 10.0 ? 0.01 : 0.0;
    }
    CHECK(heat.longest_above() == Approx(hot).margin(0.05));
    CHECK(hot > 5.0);
    CHECK(heat.peak() > heat.hottest());
    // A new cut is in bone at rest; what was reached stays.
    const double longest = heat.longest_above();
    heat.begin_cut();
    CHECK(heat.content() == 0.0);
    CHECK(heat.longest_above() == longest);
}

TEST_CASE("the ticks of the group do not change the temperature") {
    double peaks[3];
    int k = 0;
    for (const int rate : {20, 60, 1000}) {
        KerfHeat heat;
        for (int i = 0; i < 15 * rate; ++i)
            heat.advance(1.0 / rate, 0.67e-3 * (i + 1) / rate, i < 10 * rate ? 150.0 : 0.0, false);
        peaks[k++] = heat.peak();
    }
    CHECK(peaks[1] == Approx(peaks[0]).epsilon(0.02));
    CHECK(peaks[2] == Approx(peaks[0]).epsilon(0.02));
}

TEST_CASE("heat that is no number, or a cut out of range, leaves numbers, and a tick does not allocate") {
    KerfHeat heat;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const RealtimeViolations found = watch([&] {
        for (int i = 0; i < 200; ++i) {
            heat.advance(0.02, i % 3 ? 1e3 : -1.0, i % 5 ? 100.0 : nan, i % 7 == 0);
            heat.advance(0.02, nan, 100.0, false);
            heat.advance(nan, 0.0, 100.0, false);
        }
    });
    INFO(found.describe());
    CHECK(found.none());
    CHECK(std::isfinite(heat.hottest()));
    CHECK(std::isfinite(heat.content()));
}
