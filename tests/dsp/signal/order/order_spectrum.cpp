// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/order_spectrum.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

constexpr double sample_rate = 8000.0, seconds = 6.0;
constexpr double amplitudes[] = {0.0, 1.0, 0.6, 0.4, 0.25};

/// Turns after `t` seconds of a run-up from 50 to 233 Hz.
double turns_at(double t) { return 50.0 * t + 0.5 * (233.0 - 50.0) / seconds * t * t; }

std::vector<double> run_up() {
    std::vector<double> x(static_cast<std::size_t>(sample_rate * seconds));
    for (std::size_t i = 0; i < x.size(); ++i)
        for (int k = 1; k <= 4; ++k)
            x[i] += amplitudes[k] *
                    std::sin(2.0 * std::numbers::pi * k * turns_at(static_cast<double>(i) / sample_rate) + 0.4 * k);
    return x;
}

}  // namespace

TEST_CASE("orders 1 to 4 of a run-up from 50 to 233 Hz keep their amplitude within 0.1 %") {
    std::vector<double> tacho(static_cast<std::size_t>(sample_rate * seconds));
    for (std::size_t i = 0; i < tacho.size(); ++i)
        tacho[i] = std::sin(2.0 * std::numbers::pi * turns_at(static_cast<double>(i) / sample_rate));
    const signal::OrderSpectrum spectrum =
        signal::order_spectrum(run_up(), sample_rate, signal::rotation_from_tacho(tacho, sample_rate, 1.0), 8);
    REQUIRE(spectrum.orders.size() == 8);
    for (int k = 1; k <= 4; ++k) {
        const signal::OrderLevel& order = spectrum.orders[static_cast<std::size_t>(k - 1)];
        CAPTURE(k, order.amplitude);
        CHECK(order.amplitude == Approx(amplitudes[k]).epsilon(1e-3));
        CHECK(order.snr_db > 40.0);
    }
    for (int k = 5; k <= 8; ++k) CHECK(spectrum.orders[static_cast<std::size_t>(k - 1)].amplitude < 1e-3);
}

TEST_CASE("the rate of a run-up is right from its first pulse to its last, whatever the shape of the pulses") {
    for (const bool is_square : {false, true})
        for (const double low : {20.0, 50.0})
            for (const double pulses : {1.0, 4.0}) {
                std::vector<double> tacho(static_cast<std::size_t>(sample_rate * seconds));
                const auto turns = [&](double t) { return low * t + 0.5 * (233.0 - low) / seconds * t * t; };
                for (std::size_t i = 0; i < tacho.size(); ++i) {
                    tacho[i] = std::sin(2.0 * std::numbers::pi * pulses * turns(static_cast<double>(i) / sample_rate));
                    if (is_square) tacho[i] = tacho[i] > 0.0 ? 5.0 : 0.0;
                }
                const signal::Rotation rotation = signal::rotation_from_tacho(tacho, sample_rate, pulses);
                double worst = 0.0;
                for (int i = 0; i <= 1000; ++i) {
                    const auto [t, slope] =
                        rotation(std::lerp(rotation.first(), rotation.last(), static_cast<double>(i) / 1000.0));
                    worst = std::max(worst, std::abs(1.0 / slope / (low + (233.0 - low) / seconds * t) - 1.0));
                }
                CAPTURE(is_square, low, pulses);
                CHECK(worst < 1e-2);
                CHECK(signal::highest_rate(rotation) == Approx(233.0).epsilon(2e-3));
            }
}

TEST_CASE("cycles that differ are not smoothed away where the pulses locate them") {
    std::vector<double> tacho(static_cast<std::size_t>(sample_rate * seconds));
    const auto turns = [](double t) { return 30.0 * t + 0.15 * std::sin(2.0 * std::numbers::pi * 3.0 * t); };
    for (std::size_t i = 0; i < tacho.size(); ++i)
        tacho[i] = std::sin(2.0 * std::numbers::pi * turns(static_cast<double>(i) / sample_rate)) > 0.0 ? 1.0 : 0.0;
    const signal::Rotation rotation = signal::rotation_from_tacho(tacho, sample_rate, 1.0);
    CHECK(signal::highest_rate(rotation) == Approx(30.0 + 0.15 * 2.0 * std::numbers::pi * 3.0).epsilon(0.01));
}

TEST_CASE("without a tachometer the rate is followed by its ridge, in noise too") {
    std::vector<double> x = run_up();
    const Random random{3};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.2 * random.normal(i);
    signal::RidgeSettings settings;
    settings.orders = 4;
    settings.frame = 0.2;
    const signal::Ridge ridge = signal::track_ridge(x, sample_rate, settings);
    double worst = 0.0;
    for (std::size_t i = 0; i < ridge.time.size(); ++i) {
        const double truth = 50.0 + (233.0 - 50.0) / seconds * ridge.time[i];
        worst = std::max(worst, std::abs(ridge.frequency[i] / truth - 1.0));
    }
    CHECK(worst < 0.02);
    CHECK(ridge.prominence_db > 10.0);
    const signal::OrderSpectrum spectrum = signal::order_spectrum(x, sample_rate, ridge.rotation(seconds), 6);
    for (int k = 1; k <= 2; ++k)
        CHECK(spectrum.orders[static_cast<std::size_t>(k - 1)].amplitude == Approx(amplitudes[k]).epsilon(0.1));
}

TEST_CASE("the ridge of a few clean orders is their rate and not half of it, and noise has hardly one") {
    const auto mean_of = [](const signal::Ridge& ridge) {
        double sum = 0.0;
        for (const double frequency : ridge.frequency) sum += frequency / static_cast<double>(ridge.frequency.size());
        return sum;
    };
    for (const int orders : {1, 2, 3, 5}) {
        std::vector<double> x(24000);
        for (std::size_t i = 0; i < x.size(); ++i)
            for (int k = 1; k <= orders; ++k)
                x[i] += 0.5 / k *
                        std::sin(2.0 * std::numbers::pi * 100.0 * k * static_cast<double>(i) / sample_rate + k * k);
        INFO(orders << " orders");
        CHECK(mean_of(signal::track_ridge(x, sample_rate, {})) == Approx(100.0).epsilon(0.005));
    }
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        std::vector<double> noise(24000);
        const Random random{seed};
        for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = random.normal(i);
        CHECK(signal::track_ridge(noise, sample_rate, {}).prominence_db < 6.0);
    }
}

TEST_CASE("an order above half the sample rate has no level") {
    const std::vector<double> x = run_up();
    const signal::OrderSpectrum spectrum = signal::order_spectrum(
        std::span(x).first(4000), 1000.0, signal::rotation_at(120.0, 4.0), 8);  // 500 Hz are order 4.17
    REQUIRE(spectrum.orders.size() == 8);
    for (const signal::OrderLevel& order : spectrum.orders) {
        CHECK(order.above_nyquist == (order.order > 4.5));
        if (order.above_nyquist) CHECK(order.amplitude == 0.0);
    }
    CHECK(spectrum.end == Approx(500.0 / 120.0));
    CHECK(static_cast<double>(spectrum.amplitude.size() - 1) * spectrum.step <= spectrum.end);
}

TEST_CASE("orders and the ridge of a record in pieces are those of the whole, to the bit") {
    const std::vector<double> x = run_up();
    const signal::Rotation rotation = signal::rotation_at(120.0, static_cast<double>(x.size()) / sample_rate);
    signal::OrderStream stream(sample_rate, x.size(), rotation, 6);
    signal::RidgeStream ridge(sample_rate, {});
    for (std::size_t at = 0; at < x.size(); at += 777) {
        const std::span<const double> part = std::span(x).subspan(at, std::min<std::size_t>(777, x.size() - at));
        stream.push(part);
        ridge.push(part);
    }
    CHECK(stream.spectrum().amplitude == signal::order_spectrum(x, sample_rate, rotation, 6).amplitude);
    CHECK(ridge.finish().frequency == signal::track_ridge(x, sample_rate, {}).frequency);
}

TEST_CASE("a ridge of minutes is followed across the minutes") {
    std::vector<double> x(150 * 2000);
    double phase = 0.0;
    const Random random{9};
    for (std::size_t i = 0; i < x.size(); ++i) {
        phase += (100.0 + 40.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 2000.0 / 47.0)) / 2000.0;
        for (int k = 1; k <= 3; ++k) x[i] += std::sin(2.0 * std::numbers::pi * k * phase) / k;
        x[i] += 0.3 * random.normal(i);
    }
    signal::RidgeSettings settings;
    settings.lowest = 50.0;
    settings.highest = 160.0;
    settings.orders = 3;
    const signal::Ridge ridge = signal::track_ridge(x, 2000.0, settings);
    double worst = 0.0;
    for (std::size_t i = 0; i < ridge.time.size(); ++i)
        worst = std::max(worst, std::abs(ridge.frequency[i] -
                                         (100.0 + 40.0 * std::sin(2.0 * std::numbers::pi * ridge.time[i] / 47.0))));
    CHECK(ridge.time.size() > 2300);
    CHECK(worst < 4.0);
}

TEST_CASE("a fixed rate needs no tracking") {
    std::vector<double> x(16000);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = 3.0 + 0.5 * std::cos(2.0 * std::numbers::pi * 3.0 * 70.0 * static_cast<double>(i) / sample_rate);
    const signal::OrderSpectrum spectrum = signal::order_spectrum(x, sample_rate, signal::rotation_at(70.0, 2.0), 5);
    CHECK(spectrum.orders[2].amplitude == Approx(0.5).epsilon(1e-3));
    CHECK(spectrum.orders[0].amplitude < 1e-3);
    CHECK(spectrum.turns == 140.0);
}

TEST_CASE("what cannot be tracked is refused") {
    const std::vector<double> flat(1000, 1.0);
    CHECK_THROWS_WITH(signal::rotation_from_tacho(flat, sample_rate, 1.0),
                      Catch::Matchers::ContainsSubstring("at least 4"));
    CHECK_THROWS_WITH(signal::track_ridge(flat, sample_rate, {}), Catch::Matchers::ContainsSubstring("--rate"));
    CHECK_THROWS_WITH(signal::order_spectrum(flat, sample_rate, signal::rotation_at(20.0, 0.125), 4),
                      Catch::Matchers::ContainsSubstring("whole turns"));
}
