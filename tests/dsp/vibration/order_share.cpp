// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/order_share.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double sample_rate = 44100.0;

/// Orders 1 to `orders` of a rate with the amplitude 1/n, and white noise of standard deviation `noise`.
std::vector<float> machine(double rate, int orders, double noise, double wander = 0.0) {
    const Random random{3};
    std::vector<float> samples(3 * static_cast<std::size_t>(sample_rate));
    double cycles = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t = static_cast<double>(i) / sample_rate;
        cycles += rate * (1.0 + wander * std::sin(2.0 * std::numbers::pi * 0.7 * t)) / sample_rate;
        double x = noise * random.normal(i);
        for (int n = 1; n <= orders; ++n) x += std::sin(2.0 * std::numbers::pi * n * cycles + n) / n;
        samples[i] = static_cast<float>(x);
    }
    return samples;
}

}  // namespace

TEST_CASE("the share of orders is that of the periodic part in the power") {
    double lines = 0.0;
    for (int n = 1; n <= 6; ++n) lines += 0.5 / (n * n);
    for (const double noise : {0.0, 0.5, 2.0}) {
        const double expected = lines / (lines + noise * noise);
        CHECK(vibration::order_share(machine(190.0, 6, noise), sample_rate, 190.0) == Approx(expected).margin(0.03));
        CHECK(vibration::order_share(machine(190.0, 6, noise, 0.015), sample_rate, 190.0) ==
              Approx(expected).margin(0.05));
    }
}

TEST_CASE("noise and the rate of another machine have next to no share of orders") {
    CHECK(vibration::order_share(machine(190.0, 0, 1.0), sample_rate, 190.0) < 0.02);
    CHECK(vibration::order_share(machine(118.0, 4, 0.3), sample_rate, 170.0) < 0.05);
    CHECK(vibration::order_share(machine(233.0, 6, 0.0), sample_rate, 190.0) < 0.1);
}

TEST_CASE("a record that is silent, too short or without a rate has no share of orders") {
    const std::vector<float> tone = machine(200.0, 3, 0.0), silence(44100, 0.0f);
    CHECK(vibration::order_share(silence, sample_rate, 200.0) == 0.0);
    CHECK(vibration::order_share(std::span(tone).first(2000), sample_rate, 200.0) == 0.0);
    CHECK(vibration::order_share({}, sample_rate, 200.0) == 0.0);
    for (const double rate : {0.0, -5.0, std::nan(""), 30e3})
        CHECK(vibration::order_share(tone, sample_rate, rate) == 0.0);
}
