// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/similarity.hpp"

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

constexpr double record_rate = 8000.0;

struct Tone {
    double amplitude, hz, phase;
};

std::vector<double> sum_of(std::initializer_list<Tone> tones, std::size_t count = 8192) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i)
        for (const Tone& tone : tones)
            out[i] += tone.amplitude *
                      std::sin(2.0 * std::numbers::pi * tone.hz * static_cast<double>(i) / record_rate + tone.phase);
    return out;
}

const std::vector<double> r = sum_of({{1.0, 233.0, 0.0}, {0.5, 466.0, 0.3}});
const std::vector<double> d = sum_of({{0.9, 233.0, 0.1}, {0.6, 466.0, 0.0}, {0.05, 50.0, 0.0}});

std::vector<double> scaled(std::vector<double> samples, double factor) {
    for (double& x : samples) x *= factor;
    return samples;
}

}  // namespace

// The numbers of these two tones come from vibromaf 0.1 (ST-SIM, SPQI) and numpy 1.24 (SNR):
//   t = arange(8192)/8000; r = sin(2π233t) + .5 sin(2π466t + .3)
//   d = .9 sin(2π233t + .1) + .6 sin(2π466t) + .05 sin(2π50t); st_sim(d, r); spqi(d, r)
TEST_CASE("ST-SIM, SPQI and SNR of a known pair agree with the published implementation") {
    CHECK(signal::st_sim(r, d) == Approx(0.982206841322).epsilon(1e-9));
    CHECK(signal::spqi(r, d) == Approx(0.515710122868).epsilon(1e-9));
    CHECK(signal::signal_to_noise_db(r, d) == Approx(13.312769198362).epsilon(1e-9));
    CHECK(signal::spqi(scaled(r, 0.01), scaled(d, 0.01)) == Approx(0.515710122868).epsilon(1e-9));
    CHECK(signal::st_sim(r, r) == Approx(1.0));
    CHECK(signal::spqi(r, r) == Approx(1.0));
}

TEST_CASE("the threshold of touch is lowest at 250 Hz and ends at 781 Hz") {
    // dB re the threshold at 250 Hz
    const std::pair<double, double> known[] = {{20.0, 49.5},  {40.0, 39.0},  {60.0, 30.3}, {80.0, 23.1},
                                               {100.0, 17.1}, {150.0, 6.8},  {200.0, 1.5}, {300.0, 1.3},
                                               {400.0, 9.8},  {500.0, 23.7}, {600.0, 40.9}};
    for (const auto& [hz, db] : known)
        CHECK(signal::touch_threshold_db(hz) - signal::touch_threshold_db(250.0) == Approx(db).margin(0.06));
    CHECK(signal::touch_threshold_db(250.0) == Approx(-77.0));
    CHECK(signal::touch_threshold_db(780.0) < 0.0);
    CHECK(signal::touch_threshold_db(790.0) == 0.0);
}

TEST_CASE("taken as displacement, the threshold makes low frequencies of an acceleration count 12 dB per octave more") {
    for (const double hz : {40.0, 80.0, 150.0, 250.0, 400.0}) {
        const double acceleration = signal::touch_weight_db(hz, signal::ThresholdUnit::acceleration);
        CHECK(signal::touch_weight_db(hz, signal::ThresholdUnit::displacement) - acceleration ==
              Approx(12.0412 * std::log2(250.0 / hz)).margin(1e-3));
        CHECK(signal::touch_weight_db(hz, signal::ThresholdUnit::none) == 0.0);
    }
    CHECK(signal::touch_weight_db(40.0, signal::ThresholdUnit::acceleration) == Approx(-39.0).margin(0.06));
}

TEST_CASE("third-octave bands err by what was done to them") {
    std::vector<double> reference(2001, 1.0), output(2001, 1.0);
    for (std::size_t k = 300; k < 500; ++k) output[k] = 4.0;  // 150 to 250 Hz at 0.5 Hz
    const auto errors = signal::third_octave_errors({reference, output, 0.5}, 40.0, 1000.0);
    REQUIRE(errors.size() == 15);
    CHECK(errors.front().hz == Approx(39.81).epsilon(1e-3));
    CHECK(errors.back().hz == Approx(1000.0));
    for (const signal::BandError& band : errors) {
        if (std::abs(band.hz - 199.5) < 1.0) CHECK(band.error_db == Approx(6.02).margin(0.01));
        if (band.hz < 120.0 || band.hz > 320.0) CHECK(band.error_db == Approx(0.0).margin(1e-9));
    }
    // The output's gain counts before.
    CHECK(signal::third_octave_errors({reference, reference, 0.5}, 40.0, 1000.0, 2.0)[3].error_db ==
          Approx(6.02).margin(0.01));
    std::fill(output.begin(), output.end(), 0.0);
    CHECK(signal::third_octave_errors({reference, output, 0.5}, 40.0, 1000.0)[0].error_db == Approx(-60.0));
}

TEST_CASE("power of a band counts bins by their share of it") {
    const std::vector<double> flat(101, 2.0);
    CHECK(signal::band_power(flat, 10.0, 100.0, 200.0) == Approx(200.0));
    CHECK(signal::band_power(flat, 10.0, 103.0, 104.0) == Approx(2.0));
    CHECK(signal::band_power(flat, 10.0, 2000.0, 3000.0) == 0.0);
}

TEST_CASE("the same shape at another level has the cosine 1 and, its gain given back, no distance") {
    std::vector<double> reference(513), output(513);
    const Random random{4};
    for (std::size_t k = 0; k < 513; ++k) output[k] = 9.0 * (reference[k] = random.uniform(k));
    const signal::SpectrumPair pair{reference, output, 7.8125};
    CHECK(signal::spectral_cosine(pair, 40.0, 1000.0) == Approx(1.0));
    CHECK(signal::spectral_cosine(pair, 40.0, 1000.0, signal::ThresholdUnit::displacement) == Approx(1.0));
    CHECK(signal::log_spectral_distance(pair, 40.0, 500.0, 1.0 / 3.0) == Approx(0.0).margin(1e-9));
    CHECK(signal::log_spectral_distance(pair, 40.0, 500.0) == Approx(9.542).margin(0.05));
    std::fill(output.begin(), output.end(), 0.0);
    CHECK(signal::spectral_cosine(pair, 40.0, 1000.0) == 0.0);
}

TEST_CASE("spectrograms agree for one course over time and not for another") {
    std::vector<double> swell(40000), later(40000), other(40000);
    const Random random{5};
    for (std::size_t i = 0; i < swell.size(); ++i) {
        const double t = static_cast<double>(i) / record_rate, noise = random.normal(i);
        swell[i] = noise * (1.2 + std::sin(2.0 * std::numbers::pi * t));
        later[i] = noise * (1.2 - std::sin(2.0 * std::numbers::pi * t));
        other[i] = 3.0 * swell[i];
    }
    CHECK(signal::spectrogram_similarity(swell, swell, record_rate, 40.0, 1000.0) == Approx(1.0));
    CHECK(signal::spectrogram_similarity(swell, other, record_rate, 40.0, 1000.0) == Approx(1.0));
    CHECK(signal::spectrogram_similarity(swell, later, record_rate, 40.0, 1000.0) < 0.7);
}

TEST_CASE("ST-SIM of a record with itself is 1, however much of it is silent, and never above 1") {
    const Random random{31};
    for (const double silent : {0.0, 0.3, 0.9}) {
        std::vector<double> x(8192), y(8192);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] = static_cast<double>(i) < silent * static_cast<double>(x.size()) ? 0.0 : 0.3 * random.normal(i);
            y[i] = x[i] + 0.01 * random.normal(i + 100000);
        }
        CAPTURE(silent);
        CHECK(signal::st_sim(x, x) == Approx(1.0).margin(1e-9));
        CHECK(signal::st_sim(x, y) <= 1.0);
        CHECK(signal::st_sim(y, x) <= 1.0);
    }
}
