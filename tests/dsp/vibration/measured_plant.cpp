// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/measured_plant.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <complex>
#include <numbers>

using namespace tactus;

namespace {

constexpr double plant_rate = 48000.0, f0 = 120.0;

/// Acceleration of a resonator, 5 m/s² per V far above resonance, with a latency.
vibration::FrequencyResponse resonator(double damping, double latency) {
    vibration::FrequencyResponse response;
    for (double f = 20.0; f < 2000.0; f *= 1.01) {
        const std::complex<double> s(0.0, f / f0);
        response.hz.push_back(f);
        response.gain.push_back(5.0 * s * s / (s * s + 2.0 * damping * s + 1.0));
    }
    response.latency = latency;
    return response;
}

}  // namespace

TEST_CASE("a measured response as a filter has its gain at every frequency between the ends, and its latency") {
    for (const double damping : {0.1, 0.3})
        for (const double latency : {0.0, 0.01}) {
            const std::vector<float> taps = vibration::impulse_response(resonator(damping, latency), plant_rate, 4096);
            const double delay = vibration::plant_delay(resonator(damping, latency));
            CHECK(delay == Approx(1e-3).epsilon(0.02));
            REQUIRE(taps.size() == 4096);
            for (double f = 40.0; f < 1500.0; f *= 1.1) {
                std::complex<double> sum = 0.0;
                for (std::size_t i = 0; i < taps.size(); ++i)
                    sum += static_cast<double>(taps[i]) *
                           std::polar(1.0, -2.0 * std::numbers::pi * f * static_cast<double>(i) / plant_rate);
                const std::complex<double> s(0.0, f / f0);
                const std::complex<double> wanted = 5.0 * s * s / (s * s + 2.0 * damping * s + 1.0) *
                                                    std::polar(1.0, -2.0 * std::numbers::pi * f * (latency + delay));
                CAPTURE(damping, latency, f);
                CHECK(std::abs(sum - wanted) < 0.03 * std::abs(wanted) + 0.1);
            }
        }
}

TEST_CASE("a response that rings beyond the filter, or before its cause, is refused") {
    CHECK_THROWS_AS(vibration::impulse_response(resonator(0.002, 0.0), plant_rate, 4096), Error);
    vibration::FrequencyResponse early = resonator(0.3, 0.0);
    early.latency = -0.02;
    CHECK_THROWS_AS(vibration::impulse_response(early, plant_rate, 4096), Error);
}
