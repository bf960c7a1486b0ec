// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/integrator.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

TEST_CASE("an integration has the gain 1/(2 pi f) with a Butterworth high-pass, up to 0.45 of the rate") {
    for (const double rate : {500.0, 48000.0})
        for (const double low : {0.0005, 0.002, 0.02}) {
            const signal::Integrator integrator(low * rate, rate);
            for (double f = 0.1 * low * rate; f < 0.45 * rate; f *= 1.07) {
                CAPTURE(rate, low, f);
                // The high-pass is prewarped: its corner is exact, its skirts follow tan(pi f / rate).
                const double ratio = std::tan(std::numbers::pi * f / rate) / std::tan(std::numbers::pi * low);
                const double wanted =
                    ratio * ratio / std::sqrt(1.0 + std::pow(ratio, 4.0)) / (2.0 * std::numbers::pi * f);
                CHECK(std::abs(integrator.response(f)) == Approx(wanted).epsilon(5e-4));
            }
        }
}

TEST_CASE("a constant acceleration leaves no velocity, and a sine that of its amplitude over its angular frequency") {
    constexpr double rate = 2000.0, f = 50.0;
    signal::Integrator integrator(2.0, rate);
    double peak = 0.0;
    for (int i = 0; i < 8000; ++i) {
        const double y = integrator(9.81 + 3.0 * std::sin(2.0 * std::numbers::pi * f * i / rate));
        if (i >= 6000) peak = std::max(peak, std::abs(y));
    }
    CHECK(peak == Approx(3.0 / (2.0 * std::numbers::pi * f)).epsilon(2e-3));
    CHECK_THROWS(signal::Integrator(0.0, rate));
    CHECK_THROWS(signal::Integrator(200.0, rate));
}
