// SPDX-License-Identifier: Apache-2.0
// What is told while a patch runs, beside what the analysis of the whole record says.
#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/comparison.hpp"
#include "dsp/signal/spectrum/live_comparison.hpp"
#include "dsp/signal/spectrum/live_fundamental.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;

namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

/// A saw of `hz` strokes with noise; `tilt` weakens its orders by so much per order.
std::vector<float> saw(double rate, double seconds, double hz, double tilt = 0.7, std::uint64_t seed = 1) {
    const Random random{seed};
    std::vector<float> samples;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rate * seconds); ++i) {
        double y = 0.05 * random.normal(i), level = 1.0;
        for (int k = 1; k <= 6; ++k, level *= tilt)
            y += level * std::sin(2.0 * std::numbers::pi * k * hz * static_cast<double>(i) / rate + k * k);
        samples.push_back(static_cast<float>(y));
    }
    return samples;
}

/// Pushed in pieces of changing length.
void push_in_pieces(std::span<const float> samples, const std::function<void(std::span<const float>)>& push) {
    std::size_t length = 1;
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), length);
        push(samples.first(part));
        samples = samples.subspan(part);
        length = (length * 7 + 3) % 5000 + 1;
    }
}

}  // namespace

TEST_CASE("a live spectrum that forgets nothing is the spectrum of all that came") {
    for (const std::size_t segment : {std::size_t{512}, std::size_t{6144}, std::size_t{999}}) {
        INFO(segment);
        const std::vector<float> record = saw(48000.0, 2.0, 233.0);
        signal::LiveSpectrum live(48000.0, segment, forever);
        push_in_pieces(record, [&](std::span<const float> piece) { live.push(piece); });
        signal::WelchSettings settings;
        settings.segment = segment;
        settings.overlap = segment / 2;
        const signal::Spectrum whole = signal::welch<float>(record, settings);
        REQUIRE(live.spectrum().power.size() == whole.power.size());
        CHECK(live.spectrum().segments == whole.segments);
        CHECK(live.spectrum().df == Approx(whole.df));
        CHECK(live.spectrum().noise_bandwidth == Approx(whole.noise_bandwidth));
        CHECK(live.spectrum().effective_segments == Approx(whole.effective_segments).epsilon(0.05));
        const double greatest = *std::ranges::max_element(whole.power);
        for (std::size_t k = 0; k < whole.power.size(); ++k)
            REQUIRE(live.spectrum().power[k] == Approx(whole.power[k]).epsilon(1e-4).margin(2e-6 * greatest));
    }
}

TEST_CASE("a live spectrum forgets with its time constant") {
    signal::LiveSpectrum live(8000.0, 256, 0.5);
    const std::vector<float> loud = saw(8000.0, 5.0, 250.0), quiet(8000, 0.0f);
    live.push(loud);
    const double before = live.spectrum().power[8];
    live.push(quiet);  // 1 s: two time constants
    CHECK(live.spectrum().power[8] == Approx(before * std::exp(-2.0)).epsilon(0.08));
    // 2 τ / step − 1 segments count alike, less what their overlap repeats.
    CHECK(live.spectrum().effective_segments == Approx(0.947 * (2.0 * 0.5 / 0.016 - 1.0)).epsilon(0.05));
}

TEST_CASE("a sample that is not finite leaves the live spectrum finite") {
    signal::LiveSpectrum live(8000.0, 256, 0.5);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 3e38f}) {
        std::vector<float> samples = saw(8000.0, 0.5, 250.0);
        samples[100] = bad;
        live.push(samples);
        for (const double power : live.spectrum().power) REQUIRE(std::isfinite(power));
    }
}

TEST_CASE("the rate of a saw heard live is that of the record, without memory") {
    struct Saw {
        double hz;
        std::initializer_list<std::pair<int, double>> orders;  // number, amplitude
    };
    for (const Saw& one :
         {Saw{231.7, {{1, 1.0}, {2, 0.7}, {3, 0.5}, {4, 0.35}}}, Saw{166.0, {{2, 0.3}, {3, 0.02}, {4, 0.2}, {5, 0.1}}},
          Saw{60.0, {{3, 1.0}, {4, 0.3}, {5, 0.8}, {7, 0.4}}}}) {
        CAPTURE(one.hz);
        const Random random{2};
        std::vector<float> samples(48000 * 4);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            double y = 0.02 * random.normal(i);
            for (const auto& [order, level] : one.orders)
                y += level *
                     std::sin(2.0 * std::numbers::pi * order * one.hz * static_cast<double>(i) / 48000.0 + order);
            samples[i] = static_cast<float>(y);
        }
        signal::LiveSpectrum live(48000.0, 24576, 2.0);
        live.push(samples);
        signal::HarmonicSummer summer(live.spectrum().power.size());
        signal::LiveFundamental found;
        const RealtimeViolations seen =
            watch([&] { found = signal::live_fundamental(summer, live.spectrum(), 20.0, 500.0); });
        CHECK(seen.describe() == "none");
        CHECK(found.frequency == Approx(one.hz).margin(0.05));
        CHECK(found.frequency ==
              Approx(signal::find_fundamental(std::span<const float>(samples), 48000.0).frequency).margin(0.05));
        CHECK(found.confidence >= 0.25);
    }
}

TEST_CASE("live scores are those of a comparison of the whole takes", "[slow]") {
    const std::vector<float> reference = saw(48000.0, 6.0, 233.0);
    for (const double tilt : {0.7, 0.45, 0.95})
        for (const double rate : {48000.0, 44100.0, 8000.0}) {
            INFO("tilt " << tilt << ", output at " << rate << " Hz");
            std::vector<float> output = saw(rate, 6.0, 233.0, tilt, 2);
            for (float& y : output) y *= 0.1f;
            const signal::Comparison whole = signal::compare(signal::Take(std::span<const float>(reference), 48000.0),
                                                             signal::Take(std::span<const float>(output), rate));
            signal::LiveComparison live(48000.0, rate, forever);
            push_in_pieces(reference, [&](std::span<const float> piece) { live.push_reference(piece); });
            push_in_pieces(output, [&](std::span<const float> piece) { live.push_output(piece); });
            const signal::LiveScores scores = live.scores();
            REQUIRE(scores.heard);
            CHECK(scores.gain_db == Approx(whole.gain_db).margin(0.05));
            CHECK(scores.lsd_db == Approx(whole.lsd_db).margin(0.15));
            CHECK(scores.cosine_500 == Approx(whole.cosine_500).margin(0.002));
            CHECK(scores.third_octave_max_db == Approx(whole.third_octave_max_db).margin(0.3));
        }
}

TEST_CASE("nothing is said of silence, nor before two segments have come") {
    signal::LiveComparison live(8000.0, 8000.0, 1.0);
    CHECK_FALSE(live.scores().heard);
    live.push_reference(saw(8000.0, 0.6, 233.0));
    live.push_output(saw(8000.0, 0.6, 233.0));
    CHECK_FALSE(live.scores().heard);
    live.push_reference(saw(8000.0, 0.6, 233.0));
    live.push_output(saw(8000.0, 0.6, 233.0));
    CHECK(live.scores().heard);
    signal::LiveComparison dead(8000.0, 8000.0, 1.0);
    dead.push_reference(saw(8000.0, 2.0, 233.0));
    dead.push_output(std::vector<float>(16000, 0.25f));
    CHECK_FALSE(dead.scores().heard);
}
