// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/equaliser.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/filter/fir.hpp"
#include "dsp/signal/spectrum/similarity.hpp"
#include "dsp/vibration/headroom.hpp"
#include "dsp/vibration/identify.hpp"
#include "tests/dsp/vibration/audio_rate.hpp"
#include "tests/dsp/vibration/plant.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using tactus::test::audio_rate;
using tactus::test::decibel;

namespace {

/// The plant as a sweep of amplitude 0.3 finds it through hum and noise.
vibration::FrequencyResponse identified(const test::Plant& plant) {
    const vibration::SweepRun run{{20.0, 2000.0, 8.0, 0.02}, 0.3, 1.0, 1};
    std::vector<float> drive;
    for (std::size_t i = 0; i < 9 * 48000; ++i)
        drive.push_back(static_cast<float>(run.amplitude * run.sweep(static_cast<double>(i) / audio_rate)));
    std::vector<float> heard = plant(drive);
    test::add_disturbance(heard, audio_rate, -50.0, -80.0, 7);
    return vibration::identify(run, heard, audio_rate).response;
}

/// Deviation of plant and equaliser together from their mean, over the band, dB.
double deviation(const test::Plant& plant, const vibration::Equaliser& equaliser, double lowest, double highest) {
    double worst = 0.0;
    for (double f = lowest; f <= highest; f *= 1.01)
        worst = std::max(worst, std::abs(decibel(std::abs(plant.gain(f) * equaliser.gain(f)) / equaliser.mean_gain)));
    return worst;
}

}  // namespace

TEST_CASE("an equaliser of either kind makes the plant it was made for flat within 1 dB of a spread of 20 dB") {
    const test::Plant plant;
    const vibration::FrequencyResponse response = identified(plant);
    vibration::Equaliser none;
    none.taps = {1.0f};
    none.mean_gain = 1.0;
    CHECK(deviation(plant, none, 50.0, 900.0) > 10.0);
    for (const vibration::EqualiserKind kind :
         {vibration::EqualiserKind::minimum_phase, vibration::EqualiserKind::linear_phase}) {
        const vibration::Equaliser equaliser = vibration::design_equaliser(response, {.kind = kind});
        CHECK(deviation(plant, equaliser, 60.0, 950.0) < 1.0);
        CHECK(equaliser.taps.size() == 6144);
    }
}

TEST_CASE(
    "a minimum-phase equaliser answers within 2 ms, and a linear-phase one leaves a pure delay of half its length") {
    const test::Plant plant;
    const vibration::FrequencyResponse response = identified(plant);
    const vibration::Equaliser quick =
        vibration::design_equaliser(response, {.kind = vibration::EqualiserKind::minimum_phase});
    CHECK(quick.delay <= 2e-3);
    // Most of what comes out has come out by then: energy of the chain's answer to an impulse.
    std::vector<float> impulse(9600);
    impulse[0] = 1.0f;
    signal::Fir fir(quick.taps);
    std::vector<float> filtered;
    for (const float x : impulse) filtered.push_back(fir(x));
    double early = 0.0, all = 0.0;
    const std::vector<float> answer = plant(filtered);
    for (std::size_t i = 0; i < answer.size(); ++i) {
        const double energy = static_cast<double>(answer[i]) * static_cast<double>(answer[i]);
        all += energy;
        if (i < 96) early += energy;
    }
    CHECK(early > 0.8 * all);

    const vibration::Equaliser exact =
        vibration::design_equaliser(response, {.kind = vibration::EqualiserKind::linear_phase});
    CHECK(exact.delay == Approx(0.064));
    for (double f = 80.0; f < 900.0; f *= 1.1) {
        const std::complex<double> whole =
            plant.gain(f) * exact.gain(f) *
            std::polar(1.0, 2.0 * std::numbers::pi * f * (exact.delay + response.latency));
        CHECK(std::abs(std::arg(whole)) < 0.1);
    }
}

TEST_CASE("no frequency is boosted more than half a dB beyond the limit, and none outside the band is restored") {
    test::Plant deep;
    deep.resonance = 400.0;  // 45 Hz lies 38 dB below
    vibration::FrequencyResponse response;
    for (double f = 20.0; f < 2000.0; f *= 1.015) {
        response.hz.push_back(f);
        response.gain.push_back(deep.gain(f));
    }
    const vibration::Equaliser equaliser = vibration::design_equaliser(response);
    for (double f = 10.0; f < 5000.0; f *= 1.02) CHECK(std::abs(equaliser.gain(f)) < 10.7);
    CHECK(std::abs(equaliser.gain(15.0)) < 1.0);
    CHECK(std::abs(equaliser.gain(4000.0)) < 1.0);
}

TEST_CASE("a response that does not reach over the band, is silent, or lacks points makes no equaliser") {
    vibration::FrequencyResponse narrow{{100.0, 200.0, 300.0}, {1.0, 1.0, 1.0}, {}, 0.0};
    CHECK_THROWS_WITH(vibration::design_equaliser(narrow), ContainsSubstring("covers 100 to 300 Hz"));
    vibration::FrequencyResponse silent{{20.0, 200.0, 2000.0}, {0.0, 0.0, 0.0}, {}, 0.0};
    CHECK_THROWS_WITH(vibration::design_equaliser(silent), ContainsSubstring("silent"));
    CHECK_THROWS_AS(vibration::design_equaliser({}), Error);
    vibration::FrequencyResponse flat{{20.0, 200.0, 2000.0}, {1.0, 1.0, 1.0}, {}, 0.0};
    CHECK_THROWS_WITH(vibration::design_equaliser(flat, {.rate = 1500.0}), ContainsSubstring("too low"));
    CHECK_THROWS_WITH(vibration::design_equaliser(flat, {.length = 0.001}), ContainsSubstring("length"));
}

TEST_CASE("a long filter convolves, without delay, and remembers what it was given") {
    const Random random{3};
    std::vector<float> taps(37), samples(500);
    for (std::size_t i = 0; i < taps.size(); ++i) taps[i] = static_cast<float>(random.normal(i));
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(random.normal(1000 + i));
    signal::Fir fir(taps);
    for (std::size_t n = 0; n < samples.size(); ++n) {
        double sum = 0.0;
        for (std::size_t k = 0; k < taps.size() && k <= n; ++k)
            sum += static_cast<double>(taps[k]) * static_cast<double>(samples[n - k]);
        CHECK(static_cast<double>(fir(samples[n])) == Approx(sum).margin(1e-5));
        CHECK(fir.past(0) == samples[n]);
        if (n >= 36) CHECK(fir.past(36) == samples[n - 36]);
    }
    signal::Fir nothing(std::vector<float>{});
    CHECK(nothing(1.0f) == 0.0f);
}

TEST_CASE("the headroom report knows the peak, what is cut, and which band loses") {
    std::vector<double> drive(48000);
    for (std::size_t i = 0; i < drive.size(); ++i)
        drive[i] = 6.0 * std::sin(2.0 * std::numbers::pi * 200.0 * static_cast<double>(i) / audio_rate);
    const vibration::Headroom over = vibration::headroom(drive, audio_rate, 3.0);
    CHECK(over.peak == Approx(6.0).epsilon(1e-3));
    CHECK(over.headroom_db == Approx(-6.02).margin(0.01));
    CHECK(over.limited_fraction == Approx(2.0 / 3.0).margin(0.01));  // |sin| > 1/2
    REQUIRE(over.losses.size() == 1);
    CHECK(over.losses[0].hz == Approx(199.5).epsilon(0.01));
    // A sine cut at half its peak keeps the first harmonic (2/π)(asin c + c √(1 − c²)), c = 1/2.
    CHECK(over.losses[0].lost_db == Approx(-20.0 * std::log10(0.6090)).margin(0.05));
    const vibration::Headroom under = vibration::headroom(drive, audio_rate, 12.0);
    CHECK(under.headroom_db == Approx(6.02).margin(0.01));
    CHECK(under.limited_fraction == 0.0);
    CHECK(under.losses.empty());
    CHECK(vibration::headroom({}, audio_rate, 3.0).peak == 0.0);
    CHECK(vibration::voltage_within(3.0, 0.5, 4.0) == 2.0);
}
