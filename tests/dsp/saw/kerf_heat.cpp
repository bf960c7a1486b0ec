// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/kerf_heat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;
using saw::KerfHeat;
using saw::KerfMaterial;

namespace {

constexpr double pi = std::numbers::pi;

/// All heat enters the bone.
KerfMaterial dry() {
    KerfMaterial material;
    material.share = 1.0;
    return material;
}

}  // namespace

TEST_CASE("around a line source at rest the temperature is the exponential integral") {
    // T = q / (4 π k) E1(r² / (4 α t)) for q W per metre; E1(x) = -Ei(-x).
    const KerfMaterial material = dry();
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
    const KerfMaterial material = dry();
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

TEST_CASE("without irrigation no heat is lost") {
    KerfHeat heat;
    double given = 0.0;
    for (int i = 0; i < 600; ++i) {
        const double q = i % 100 < 60 ? 80.0 : 0.0;
        heat.advance(0.02, 1e-5 * i, q, false);
        given += 0.02 * q * KerfMaterial{}.share;
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

TEST_CASE("the time above the limit is that of the place which was longest above it") {
    KerfHeat heat;
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
