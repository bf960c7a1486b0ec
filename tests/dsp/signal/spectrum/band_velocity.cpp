// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/band_velocity.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double pi = std::numbers::pi;

/// Of 1 m/s² rms, plus an offset.
std::vector<double> sine(double hz, double rate, double seconds) {
    std::vector<double> x(static_cast<std::size_t>(seconds * rate));
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = 9.81 + std::numbers::sqrt2 * std::sin(2.0 * pi * hz * static_cast<double>(i) / rate + 0.7);
    return x;
}

double velocity(const std::vector<double>& x, double rate) {
    signal::BandVelocity band(10.0, 1000.0, rate, x.size());
    band.push(std::span(x).first(x.size() / 3));
    band.push(std::span(x).subspan(x.size() / 3));
    REQUIRE(band.is_resolved());
    return band.rms();
}

}  // namespace

TEST_CASE("velocity in a band is that of a sine right up to the borders of the band") {
    for (const double rate : {2000.0, 8000.0, 11025.0, 48000.0})
        for (const double seconds : {5.0, 20.0, 60.0}) {
            if (rate * seconds > 1e6) continue;
            for (const double hz : {10.2, 10.5, 11.0, 12.5, 16.3, 31.7, 100.0, 453.2, 871.0, 990.0}) {
                CAPTURE(rate, seconds, hz);
                CHECK(velocity(sine(hz, rate, seconds), rate) == Approx(1.0 / (2.0 * pi * hz)).epsilon(2e-3));
            }
            // Outside nothing counts but what the side lobes of the window leave.
            for (const double hz : {5.0, 9.8}) {
                CAPTURE(rate, seconds, hz);
                CHECK(velocity(sine(hz, rate, seconds), rate) < 2e-2 / (2.0 * pi * hz));
            }
        }
}

TEST_CASE("velocity in a band of noise is that of its density, and no section spans a gap") {
    constexpr double rate = 4000.0;
    const Random random(5);
    std::vector<double> x(static_cast<std::size_t>(400.0 * rate));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = random.normal(i);
    // Density 2/rate: the integral of 2/rate/(2 pi f)^2 from 10 to 1000 Hz.
    const double expected = std::sqrt(2.0 / rate / (4.0 * pi * pi) * (1.0 / 10.0 - 1.0 / 1000.0));
    CHECK(velocity(x, rate) == Approx(expected).epsilon(0.03));

    // A step of phase at the gap would be a click.
    const std::vector<double> first = sine(100.0, rate, 10.0);
    signal::BandVelocity band(10.0, 1000.0, rate, 2 * first.size());
    band.push(first);
    band.gap();
    std::vector<double> second = first;
    for (double& value : second) value = -value;
    band.push(second);
    CHECK(band.rms() == Approx(1.0 / (2.0 * pi * 100.0)).epsilon(1e-4));

    signal::BandVelocity short_record(10.0, 1000.0, rate, 1000);
    short_record.push(std::span(first).first(1000));
    CHECK_FALSE(short_record.is_resolved());
}
