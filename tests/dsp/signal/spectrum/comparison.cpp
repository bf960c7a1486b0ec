// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/comparison.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "tests/dsp/vibration/plant.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double compared_rate = 48000.0;

std::vector<float> at_rate(const std::vector<float>& samples, double to) {
    const std::vector<double> moved = signal::resample(samples, compared_rate, to);
    return {moved.begin(), moved.end()};
}

std::vector<float> louder(std::vector<float> samples, float factor) {
    for (float& x : samples) x *= factor;
    return samples;
}

}  // namespace

// scipy 1.10.1, the pair of tests/dsp/signal/spectrum/similarity.cpp: welch(x, 8000, 'hann', 1024, 512, detrend=False),
// floor at −40 dB of the largest, 40 to 500 Hz.
TEST_CASE("distance and cosine of a known pair agree with scipy's spectra") {
    std::vector<double> r(8192), d(8192);
    for (std::size_t i = 0; i < r.size(); ++i) {
        const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / 8000.0;
        r[i] = std::sin(233.0 * t) + 0.5 * std::sin(466.0 * t + 0.3);
        d[i] = 0.9 * std::sin(233.0 * t + 0.1) + 0.6 * std::sin(466.0 * t) + 0.05 * std::sin(50.0 * t);
    }
    signal::WelchSettings settings;
    settings.rate = 8000.0;
    settings.segment = 1024;
    settings.overlap = 512;
    settings.detrend = signal::Detrend::none;
    const signal::Spectrum a = signal::welch<double>(r, settings), b = signal::welch<double>(d, settings);
    CHECK(signal::log_spectral_distance({a.power, b.power, a.df}, 40.0, 500.0) == Approx(2.396848788987).epsilon(1e-9));
    CHECK(signal::spectral_cosine({a.power, b.power, a.df}, 40.0, 500.0) == Approx(0.991256496561).epsilon(1e-9));
}

TEST_CASE("a take is the same as itself at another level, rate and time") {
    const std::vector<float> take = test::saw(233.0, true, 8.0, compared_rate, 1);
    const std::vector<float> later = louder(at_rate({take.begin() + 5000, take.end()}, 44100.0), 0.1f);
    const signal::Comparison same = signal::compare({take, compared_rate}, {later, 44100.0});
    CHECK(same.alignment.significant);
    CHECK(same.alignment.delay == Approx(-5000.0 / compared_rate).margin(2e-5));
    CHECK(same.gain_db == Approx(20.0).margin(0.02));
    CHECK(same.lsd_db < 0.1);
    CHECK(same.cosine_1000 > 0.9999);
    CHECK(same.third_octave_max_db < 0.1);
    CHECK(same.harmonic_error_db.value() < 0.05);
    CHECK(same.st_sim.value() > 0.99);
    CHECK(same.spqi.value() > 0.99);
    CHECK(same.coherence_mean.value() > 0.999);
    CHECK(same.spectrogram_similarity > 0.95);
    CHECK(same.reference_hz == Approx(233.0).margin(0.05));
    CHECK(same.lines.only_in_output.empty());
    CHECK(same.lines.only_in_reference.empty());
    CHECK(same.lines.in_both.size() == 4);
}

TEST_CASE("two takes of one saw at 233 and 233.4 Hz score as the same saw, and another saw does not") {
    for (const bool cutting : {false, true}) {
        INFO((cutting ? "cutting" : "idle"));
        const std::vector<float> take = test::saw(233.0, cutting, 10.0, compared_rate, 1);
        const std::vector<float> another = test::saw(233.4, cutting, 10.0, compared_rate, 2);
        const signal::Comparison same = signal::compare({take, compared_rate}, {another, compared_rate});
        CHECK_FALSE(same.alignment.significant);
        CHECK_FALSE(same.st_sim.has_value());
        CHECK_FALSE(same.spqi.has_value());
        CHECK_FALSE(same.coherence_mean.has_value());
        CHECK(same.speed_ratio == Approx(233.4 / 233.0).epsilon(1e-4));
        CHECK(same.gain_db == Approx(0.0).margin(0.2));
        CHECK(same.lsd_db < 1.0);
        CHECK(same.cosine_500 > 0.999);
        CHECK(same.cosine_1000 > 0.995);
        CHECK(same.third_octave_max_db < 1.5);
        CHECK(same.harmonic_error_db.value() < 0.5);
        CHECK(same.lines.only_in_output.empty());
        CHECK(same.lines.only_in_reference.empty());

        const signal::Comparison other =
            signal::compare({take, compared_rate}, {test::saw(150.0, cutting, 10.0, compared_rate, 2), compared_rate});
        CHECK(other.lsd_db > 5.0);
        CHECK(other.cosine_500 < 0.7);
        CHECK(other.lines.only_in_output.size() >= 3);
    }
}

TEST_CASE("saws at orders of the mains are compared at equal orders, as at other rates") {
    struct Case {
        double reference, output;
        int orders;
        double slope;  // amplitude of order k: k to the power of −slope
    };
    // One record does not exclude hum: the other has the same orders at a rate that is none of the mains.
    for (const Case& one : {Case{100.0, 100.7, 7, 1.0}, Case{120.0, 121.0, 7, 1.0}, Case{60.0, 60.4, 7, 0.8},
                            Case{50.7, 50.0, 6, 1.0}, Case{100.0, 101.0, 3, 1.0}, Case{61.0, 60.0, 4, 1.0}}) {
        CAPTURE(one.reference, one.output, one.orders);
        const auto saw = [&](double hz, std::uint64_t seed) {
            const Random random{seed};
            std::vector<double> x(8 * 8000);
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double angle = 2.0 * std::numbers::pi * hz * static_cast<double>(i) / 8000.0;
                x[i] = 0.02 * random.normal(i);
                for (int k = 1; k <= one.orders; ++k) x[i] += std::pow(k, -one.slope) * std::sin(k * angle + k * k);
            }
            return x;
        };
        const std::vector<double> r = saw(one.reference, 1), d = saw(one.output, 2);
        const signal::Comparison found = signal::compare({std::span(r), 8000.0}, {std::span(d), 8000.0});
        CHECK(found.speed_ratio == Approx(one.output / one.reference).epsilon(1e-4));
        CHECK(found.lsd_db < 0.5);
        CHECK(found.harmonic_error_db.value_or(99.0) < 0.5);
        CHECK(found.lines.only_in_reference.empty());
        CHECK(found.lines.only_in_output.empty());
        CHECK(found.lines.in_both.size() >= static_cast<std::size_t>(one.orders));
    }
}

TEST_CASE("what may be hum in one take is no saw by the other, unless that has its orders at another rate") {
    // Orders by number, with their amplitudes.
    using Orders = std::vector<std::pair<int, double>>;
    const auto record = [](double hz, const Orders& orders, std::uint64_t seed) {
        const Random random{seed};
        std::vector<double> x(8 * 8000);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double angle = 2.0 * std::numbers::pi * hz * static_cast<double>(i) / 8000.0;
            x[i] = 0.005 * random.normal(i);
            for (const auto& [k, amplitude] : orders) x[i] += amplitude * std::sin(k * angle + k * k);
        }
        return x;
    };
    const Orders saw{{1, 1.0}, {2, 0.5}, {3, 0.33}, {4, 0.25}, {5, 0.2}, {6, 0.17}, {7, 0.14}},
        hum{{1, 1.0}, {2, 0.1}, {3, 0.3}, {5, 0.1}},
        rectifier{{1, 0.33}, {2, 0.067}, {3, 0.029}, {4, 0.016}, {5, 0.01}, {6, 0.007}};
    struct Case {
        double reference, output;
        const Orders &reference_orders, &output_orders;
    };
    // Two rates of one saw, or of the mains at two times.
    for (const Case& one : {Case{120.0, 120.3, saw, saw}, Case{99.7, 100.0, saw, saw}, Case{49.85, 50.2, hum, hum},
                            Case{99.7, 100.4, rectifier, rectifier}, Case{59.9, 60.1, saw, saw}}) {
        CAPTURE(one.reference, one.output);
        const std::vector<double> r = record(one.reference, one.reference_orders, 1),
                                  d = record(one.output, one.output_orders, 2);
        const signal::Comparison found = signal::compare({std::span(r), 8000.0}, {std::span(d), 8000.0});
        CHECK(found.reference_hz == 0.0);
        CHECK(found.output_hz == 0.0);
        CHECK(found.reference_hum_hz == Approx(one.reference).margin(0.01));
        CHECK(found.output_hum_hz == Approx(one.output).margin(0.01));
        CHECK(found.speed_ratio == 1.0);
    }
    // A saw near the mains does not make hum a saw: order 4 is in one of them only.
    for (const Case& one :
         {Case{50.0, 51.0, hum, saw}, Case{50.1, 49.2, hum, saw}, Case{100.0, 101.2, rectifier, saw}}) {
        CAPTURE(one.reference, one.output);
        const std::vector<double> r = record(one.reference, one.reference_orders, 1),
                                  d = record(one.output, one.output_orders, 2);
        const signal::Comparison found = signal::compare({std::span(r), 8000.0}, {std::span(d), 8000.0});
        CHECK(found.reference_hz == 0.0);
        CHECK(found.reference_hum_hz == Approx(one.reference).margin(0.01));
        CHECK(found.output_hz == Approx(one.output).margin(0.01));
        CHECK(found.speed_ratio == 1.0);
    }
}

TEST_CASE("hum is no saw, and a rate that may be hum is reported as such") {
    const Random random{3};
    std::vector<double> r(8 * 8000), d(r.size());
    for (std::size_t i = 0; i < r.size(); ++i) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / 8000.0;
        r[i] = 0.02 * random.normal(i), d[i] = 0.02 * random.normal(i + r.size());
        for (const int k : {1, 2, 3, 5}) r[i] += std::sin(50.0 * k * angle + k) / (k * k);
        for (const int k : {1, 2, 3}) d[i] += std::sin(100.0 * k * angle + k) / (k * k);
    }
    const signal::Comparison found = signal::compare({std::span(r), 8000.0}, {std::span(d), 8000.0});
    CHECK(found.reference_hz == 0.0);
    CHECK(found.output_hz == 0.0);
    CHECK(found.reference_hum_hz == Approx(50.0).margin(0.01));
    CHECK(found.output_hum_hz == Approx(100.0).margin(0.01));
}

TEST_CASE("mains hum that only the output has is found, and named by its frequency") {
    const std::vector<float> take = test::saw(233.0, false, 10.0, compared_rate, 1);
    std::vector<float> hummed = test::saw(233.0, false, 10.0, compared_rate, 3);
    test::add_disturbance(hummed, compared_rate, -40.0, -80.0, 5);
    const signal::Comparison found = signal::compare({take, compared_rate}, {hummed, compared_rate});
    REQUIRE(found.lines.only_in_output.size() == 1);
    CHECK(found.lines.only_in_output[0].frequency == Approx(50.0).margin(0.05));
    CHECK(signal::level_db(found.lines.only_in_output[0]) == Approx(-40.0).margin(0.2));
    const signal::Comparison turned = signal::compare({hummed, compared_rate}, {take, compared_rate});
    REQUIRE(turned.lines.only_in_reference.size() == 1);
    CHECK(turned.lines.only_in_reference[0].frequency == Approx(50.0).margin(0.05));
}

TEST_CASE("a slow sensor is compared as far as it goes") {
    const std::vector<float> take = test::saw(150.0, false, 6.0, compared_rate, 1);
    const signal::Comparison found = signal::compare({take, compared_rate}, {at_rate(take, 1000.0), 1000.0});
    CHECK(found.highest == Approx(450.0));
    CHECK(found.third_octaves.back().hz < 450.0);
    CHECK(found.cosine_1000 > 0.999);
    CHECK_THROWS_WITH(signal::compare({take, compared_rate}, {at_rate(take, 160.0), 160.0}),
                      ContainsSubstring("can be trusted to 72 Hz only"));
}

TEST_CASE("silence, and takes too short to tell, are refused by name") {
    const std::vector<float> take = test::saw(233.0, false, 2.0, compared_rate, 1), silent(96000, 0.0f),
                             bit(1000, 0.1f);
    CHECK_THROWS_WITH(signal::compare({silent, compared_rate}, {take, compared_rate}),
                      ContainsSubstring("reference is silent"));
    CHECK_THROWS_WITH(signal::compare({take, compared_rate}, {silent, compared_rate}),
                      ContainsSubstring("output is silent"));
    CHECK_THROWS_WITH(signal::compare({bit, compared_rate}, {take, compared_rate}),
                      ContainsSubstring("reference is shorter"));
    CHECK_THROWS_WITH(signal::compare({take, compared_rate}, {std::vector<float>(), compared_rate}),
                      ContainsSubstring("output is shorter"));
    const std::vector<float> direct(96000, 0.5f);
    CHECK_THROWS_WITH(signal::compare({take, compared_rate}, {direct, compared_rate}),
                      ContainsSubstring("output is silent"));
}

TEST_CASE("only the band that both takes can be trusted in is compared") {
    const std::vector<float> take = test::saw(233.0, true, 6.0, compared_rate, 1);
    signal::Take trusted(take, compared_rate);
    trusted.usable = 300.0;
    const signal::Comparison found = signal::compare({take, compared_rate}, trusted);
    CHECK(found.highest == 300.0);
    CHECK(found.touched() == 300.0);
    CHECK(found.third_octaves.back().hz * std::pow(10.0, 0.05) < 300.1);
    CHECK_FALSE(found.st_sim.has_value());
    for (const signal::SpectralLine& line : found.lines.in_both) CHECK(line.frequency < 300.0);
    trusted.usable = 42.0;
    CHECK_THROWS_WITH(signal::compare({take, compared_rate}, trusted), ContainsSubstring("output, sampled at 48 kHz"));
}

TEST_CASE("noise has nothing above itself, and what a saw has above its noise is named") {
    std::vector<double> white(48000), red(48000);
    std::uint64_t state = 1;
    double sum = 0.0;
    for (std::size_t i = 0; i < white.size(); ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        white[i] = static_cast<double>(state >> 11) * 0x1.0p-53 - 0.5;
        red[i] = sum = 0.999 * sum + white[i];
    }
    const signal::Comparison noise = signal::compare({std::span<const double>(white).first(24000), 8000.0},
                                                     {std::span<const double>(white).last(24000), 8000.0});
    CHECK(noise.lsd_db < 2.0);  // all that was judged before
    CHECK(noise.above_noise.in_both.empty());
    CHECK(signal::compare({std::span<const double>(red).first(24000), 8000.0},
                          {std::span<const double>(red).last(24000), 8000.0})
              .above_noise.in_both.empty());
    const std::vector<float> a = test::saw(233.0, false, 6.0, compared_rate, 1),
                             b = test::saw(233.0, false, 6.0, compared_rate, 2);
    CHECK(signal::compare({a, compared_rate}, {b, compared_rate}).above_noise.in_both.size() >= 2);
}

TEST_CASE("spectra of several axes add their powers") {
    std::vector<double> x(48000), y(48000), none(48000, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / 8000.0;
        x[i] = 3.0 * std::sin(100.0 * t) + 0.5 * std::sin(200.0 * t);
        y[i] = 4.0 * std::sin(100.0 * t + 1.0);
    }
    signal::ComparisonOptions options;
    options.reference_axes.emplace_back(std::span<const double>(y), 8000.0);
    options.output_axes.emplace_back(std::span<const double>(none), 8000.0);
    const signal::Comparison found =
        signal::compare({std::span<const double>(x), 8000.0}, {std::span<const double>(x), 8000.0}, options);
    CHECK(found.reference_rms == Approx(std::sqrt(12.5 + 0.125)).epsilon(1e-3));  // of 3, 4 and 0.5
    CHECK(found.output_rms == Approx(std::sqrt(4.5 + 0.125)).epsilon(1e-3));
}

TEST_CASE("unrelated noises that a motor modulates alike were not recorded together") {
    // Their spectra repeat every 8 Hz, by which their correlation has higher peaks of chance.
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        CAPTURE(seed);
        std::vector<double> takes[2];
        for (std::size_t take = 0; take < 2; ++take) {
            const Random random{seed + 100 * take};
            double fast = 0.0, slow = 0.0;
            for (std::size_t i = 0; i < 48000; ++i) {
                fast += 0.4 * (random.normal(i) - fast), slow += 0.05 * (fast - slow);
                takes[take].push_back((fast - slow) * (1.0 + 0.8 * std::sin(6.2832e-3 * static_cast<double>(i) +
                                                                            static_cast<double>(take))));
            }
        }
        const signal::Comparison found =
            signal::compare({std::span<const double>(takes[0]), 8000.0}, {std::span<const double>(takes[1]), 8000.0});
        CHECK_FALSE(found.alignment.significant);
        CHECK(found.statistics);
    }
}
