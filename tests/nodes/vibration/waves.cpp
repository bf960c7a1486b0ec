// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double wave_rate = 48000.0;

std::vector<float> wave(const char* shape, const char* frequency, const char* width = "50 %",
                        std::int64_t count = 48000) {
    NodeHarness node("oscillator");
    node.set("shape", shape).set("frequency", frequency).set("width", width);
    node.prepare();
    node.run(count);
    return node.values<float>("signal");
}

/// Amplitude of the part at `frequency` of a second of samples, by the definition of Fourier's coefficient.
double amplitude_at(const std::vector<float>& samples, double frequency) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k)
        sum += static_cast<double>(samples[k]) *
               std::polar(1.0, -2.0 * std::numbers::pi * frequency * static_cast<double>(k) / wave_rate);
    return 2.0 * std::abs(sum) / static_cast<double>(samples.size());
}

double power_of(const std::vector<float>& samples) {
    double sum = 0.0;
    for (const float x : samples) sum += static_cast<double>(x) * static_cast<double>(x);
    return sum / static_cast<double>(samples.size());
}

/// Power that is at no harmonic of `frequency`, relative to all, in dB.
double aliases_dB(const std::vector<float>& samples, double frequency) {
    double harmonic = 0.0;
    for (double f = frequency; f < wave_rate / 2.0; f += frequency)
        harmonic += 0.5 * std::pow(amplitude_at(samples, f), 2.0);
    return 10.0 * std::log10(std::max(power_of(samples) - harmonic, 1e-12) / power_of(samples));
}

}  // namespace

TEST_CASE("the harmonics of a sawtooth, a pulse and a triangle are those of Fourier") {
    const auto saw = wave("sawtooth", "100 Hz"), pulse = wave("pulse", "100 Hz", "25 %"),
               tri = wave("triangle", "100 Hz");
    for (int n = 1; n <= 20; ++n) {
        INFO(n);
        CHECK(amplitude_at(saw, 100.0 * n) == Approx(2.0 / (pi * n)).epsilon(0.02));
        CHECK(amplitude_at(pulse, 100.0 * n) ==
              Approx(4.0 / (pi * n) * std::abs(std::sin(pi * n * 0.25))).epsilon(0.02).margin(1e-3));
        CHECK(amplitude_at(tri, 100.0 * n) ==
              Approx(n % 2 == 1 ? 8.0 / (pi * pi * n * n) : 0.0).epsilon(0.02).margin(1e-4));
    }
}

TEST_CASE("steps alias far less than without correction") {
    // 1237 Hz has no harmonic that falls on another's mirror image.
    CHECK(aliases_dB(wave("sawtooth", "1237 Hz"), 1237.0) < -30.0);
    CHECK(aliases_dB(wave("pulse", "1237 Hz"), 1237.0) < -30.0);
    CHECK(aliases_dB(wave("triangle", "1237 Hz"), 1237.0) < -60.0);
}

TEST_CASE("white noise is flat and pink noise falls by 3 dB per octave, both at their level") {
    for (const bool is_pink : {false, true}) {
        NodeHarness node("noise");
        node.set("colour", is_pink ? "pink" : "white").set("level", "0.2");
        node.prepare();
        node.run(960'000);
        const auto samples = node.values<float>("signal");
        CHECK(std::sqrt(power_of(samples)) == Approx(0.2).epsilon(is_pink ? 0.05 : 0.01));
        // Power in each octave by sums over bands of a long transform would need a window, a difference of two
        // neighbouring averages does not: power of the Haar bands.
        std::vector<double> level(samples.begin(), samples.end());
        std::vector<double> bands;
        while (level.size() > 2000) {
            double power = 0.0;
            std::vector<double> next;
            for (std::size_t k = 0; k + 1 < level.size(); k += 2) {
                const double low = (level[k] + level[k + 1]) / std::numbers::sqrt2,
                             high = (level[k] - level[k + 1]) / std::numbers::sqrt2;
                power += high * high;
                next.push_back(low);
            }
            bands.push_back(power / static_cast<double>(next.size()));
            level = std::move(next);
        }
        for (std::size_t b = 2; b + 1 < 7; ++b) {
            const double rise_dB = 10.0 * std::log10(bands[b + 1] / bands[b]);
            INFO(b);
            CHECK(rise_dB == Approx(is_pink ? 3.01 : 0.0).margin(0.4));
        }
    }
}

TEST_CASE("the oscillator's sine is a sine, its phase a phasor") {
    NodeHarness node("oscillator");
    node.set("shape", "sine").set("frequency", "123.4 Hz").set("amplitude", "2");
    node.prepare();
    node.run(480'000, 1);
    const auto wave = node.values<float>("signal"), phase = node.values<float>("phase");
    double off = 0.0, phase_off = 0.0;
    for (std::size_t k = 0; k < wave.size(); ++k) {
        const double cycles = 123.4 * static_cast<double>(k) / wave_rate, part = cycles - std::floor(cycles);
        off = std::max(off, std::abs(static_cast<double>(wave[k]) - 2.0 * std::sin(2.0 * std::numbers::pi * part)));
        const double gap = std::abs(static_cast<double>(phase[k]) - part);
        phase_off = std::max(phase_off, std::min(gap, 1.0 - gap));
        CHECK(phase[k] < 1.0f);
    }
    CHECK(off < 1e-6);
    CHECK(phase_off < 1e-6);
}

TEST_CASE("neighbours of white noise are not related") {
    NodeHarness node("noise");
    node.set("level", "1");
    node.prepare();
    node.run(480'000);
    const auto x = node.values<float>("signal");
    for (std::size_t lag = 1; lag < 200; ++lag) {
        double sum = 0.0;
        for (std::size_t k = lag; k < x.size(); ++k) sum += static_cast<double>(x[k]) * static_cast<double>(x[k - lag]);
        INFO(lag);
        CHECK(std::abs(sum / static_cast<double>(x.size())) < 5.0 / std::sqrt(480'000.0));
    }
}
