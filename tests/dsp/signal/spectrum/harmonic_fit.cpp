// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/harmonic_fit.hpp"

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

/// Orders 1 to 4 of amplitude 1/k in white noise of this standard deviation.
std::vector<double> orders(double frequency, double rate, std::size_t count, double noise, std::uint64_t seed) {
    std::vector<double> x(count);
    const Random random{seed};
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 1; k <= 4; ++k)
            x[i] += std::cos(turn * k * frequency * static_cast<double>(i) / rate + k + static_cast<double>(seed)) / k;
        x[i] += noise * random.normal(i);
    }
    return x;
}

/// Cramér–Rao bound, Hz, of the rate of those orders: √(6 σ² / (π² T² N Σ k² a_k²)) with Σ k² a_k² = 4.
double bound(double rate, std::size_t count, double noise) {
    const double n = static_cast<double>(count), seconds = n / rate;
    return std::sqrt(6.0 * noise * noise / (std::numbers::pi * std::numbers::pi * seconds * seconds * n * 4.0));
}

}  // namespace

TEST_CASE("a fitted rate has the Cramer-Rao deviation, and states it") {
    for (const auto& [frequency, rate, count] :
         {std::tuple{189.71, 3200.0, 3200u}, std::tuple{24.7, 12800.0, 12800u}, std::tuple{9.3, 1000.0, 1500u}}) {
        double square = 0.0, stated = 0.0;
        constexpr int seeds = 60;
        const double noise = 0.3, start = frequency + 0.02 * rate / count;
        for (int seed = 0; seed < seeds; ++seed) {
            const signal::HarmonicFit fit =
                signal::fit_harmonics(orders(frequency, rate, count, noise, static_cast<std::uint64_t>(seed)), rate,
                                      start, std::array{1, 2, 3, 4}, {});
            square += (fit.frequency - frequency) * (fit.frequency - frequency) / seeds;
            stated += fit.deviation / seeds;
        }
        CAPTURE(frequency);
        CHECK(std::sqrt(square) < 1.3 * bound(rate, count, noise));
        CHECK(stated == Approx(bound(rate, count, noise)).epsilon(0.1));
    }
}

TEST_CASE("without noise a fit of few periods is exact, also beside a line of another origin") {
    std::vector<double> x = orders(31.7, 2000.0, 500, 0.0, 3);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] += 3.0 + 0.7 * std::sin(turn * 50.0 * static_cast<double>(i) / 2000.0);
    CHECK(signal::fit_harmonics(x, 2000.0, 31.65, std::array{1, 2, 3, 4}, std::array{50.0}).frequency ==
          Approx(31.7).margin(1e-6));
}

TEST_CASE("the fundamental of a steady record is never worse than 1.5 times the Cramer-Rao bound", "[slow]") {
    double square = 0.0, worst = 0.0;
    constexpr int seeds = 100;
    for (int seed = 0; seed < seeds; ++seed) {
        const signal::FundamentalEstimate found = signal::find_fundamental(
            std::span<const double>(orders(189.71, 3200.0, 6400, 0.5, 100 + static_cast<std::uint64_t>(seed))), 3200.0);
        square += (found.frequency - 189.71) * (found.frequency - 189.71) / seeds;
        worst = std::max(worst, std::abs(found.frequency - 189.71));
        CHECK(found.is_certain());
    }
    INFO("worst " << worst << " Hz");
    CHECK(std::sqrt(square) < 1.5 * bound(3200.0, 6400, 0.5));
}

TEST_CASE("a motor below 39 Hz is certain and right at any sample rate", "[slow]") {
    for (const double rate : {1000.0, 2000.0, 12800.0, 44100.0})
        for (const double frequency : {7.3, 20.8, 24.7, 29.2, 33.4, 38.0}) {
            CAPTURE(rate, frequency);
            const signal::FundamentalEstimate found = signal::find_fundamental(
                std::span<const double>(orders(frequency, rate, static_cast<std::size_t>(2.0 * rate), 0.05, 9)), rate);
            CHECK(found.is_certain());
            CHECK(found.frequency == Approx(frequency).epsilon(1e-4));
        }
}
