// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/biquad_block.hpp"
#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/filter/oscillator.hpp"
#include "dsp/signal/filter/ramp.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double rate = 48000.0;

/// Gain of whatever maps a sample to a sample, in dB, measured with a sine after it has settled for a second.
template <class Filter>
double measured_gain(Filter filter, double frequency) {
    const double step = 2.0 * pi * frequency / rate;
    std::complex<double> in = 0.0, out = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const double x = std::sin(step * i), y = filter(x);
        if (i < 48000) continue;
        in += x * std::polar(1.0, -step * i);
        out += y * std::polar(1.0, -step * i);
    }
    return 20.0 * std::log10(std::abs(out) / std::abs(in));
}

constexpr double half_power = -3.0103;  // dB

}  // namespace

TEST_CASE("low-pass and high-pass are 3 dB down at their frequency and fall 12 dB per octave beyond") {
    const signal::Biquad low{signal::lowpass(1000.0, rate)}, high{signal::highpass(1000.0, rate)};
    CHECK(measured_gain(low, 1000.0) == Approx(half_power).margin(0.005));
    CHECK(measured_gain(high, 1000.0) == Approx(half_power).margin(0.005));
    CHECK(measured_gain(low, 20.0) == Approx(0.0).margin(0.005));
    CHECK(measured_gain(high, 10000.0) == Approx(0.0).margin(0.005));
    // Where the bilinear warp is still small.
    const signal::Biquad slow{signal::lowpass(50.0, rate)};
    CHECK(measured_gain(slow, 400.0) - measured_gain(slow, 800.0) == Approx(12.04).margin(0.1));
    CHECK(measured_gain(high, 124.0) - measured_gain(high, 62.0) == Approx(12.04).margin(0.1));
}

TEST_CASE("a block of a biquad has the bits of single samples, whatever the samples are") {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const Random random{9};
    std::vector<float> in;
    for (std::uint64_t n = 0; n < 5000; ++n) {
        const std::uint64_t kind = random.bits(2 * n) % 40;
        const auto any = static_cast<float>(random.normal(2 * n + 1));
        in.push_back(kind == 0   ? 0.0f
                     : kind == 1 ? -0.0f
                     : kind == 2 ? infinite
                     : kind == 3 ? std::numeric_limits<float>::quiet_NaN()
                     : kind == 4 ? any * 1e38f
                     : kind == 5 ? any * 1e-44f
                                 : any);
        // Silence, in which only the signs of zeros differ.
        if (n % 500 < 120) in.back() = n % 3 == 0 ? -0.0f : 0.0f;
    }
    for (const signal::BiquadCoefficients& c :
         {signal::bandpass(250.0, rate, 1.0), signal::bandpass(20000.0, rate, 8.0), signal::lowpass(300.0, rate),
          signal::highpass(40.0, rate), signal::notch(50.0, rate, 3.0), signal::BiquadCoefficients{0.5, -0.0, 0.1}}) {
        signal::BlockBiquad single{c}, whole{c};
        signal::Biquad other{c};
        std::vector<float> out(in.size());
        std::size_t from = 0;
        for (int count = 1; from < in.size(); count = count % 150 + 7) {
            const int part = std::min(count, static_cast<int>(in.size() - from));
            whole.run(in.data() + from, out.data() + from, part);
            from += static_cast<std::size_t>(part);
        }
        std::size_t different = 0;
        double loudest = 1.0;
        for (std::size_t i = 0; i < in.size(); ++i) {
            const double x = signal::finite_or_zero(in[i]), y = other(x);
            const float wanted = signal::to_sample(single(x));
            if (std::abs(single.last - y) > 1e-11 * loudest) FAIL_CHECK(i << ": " << single.last << ", not " << y);
            loudest = std::max(loudest, std::abs(y));
            different += std::bit_cast<std::uint32_t>(wanted) != std::bit_cast<std::uint32_t>(out[i]);
        }
        CHECK(different == 0);
        CHECK(std::bit_cast<std::uint64_t>(single.further) == std::bit_cast<std::uint64_t>(whole.further));
    }
}

TEST_CASE("the gain of a low-pass at its frequency is its quality factor") {
    for (const double q : {0.5, 2.0, 10.0})
        CHECK(measured_gain(signal::Biquad{signal::lowpass(300.0, rate, q)}, 300.0) ==
              Approx(20.0 * std::log10(q)).margin(0.01));
}

TEST_CASE("a band-pass keeps its centre, is frequency/q wide, and falls 6 dB per octave on both sides") {
    const double centre = 200.0, q = 2.0;
    const signal::Biquad band{signal::bandpass(centre, rate, q)};
    CHECK(measured_gain(band, centre) == Approx(0.0).margin(0.005));
    // The band edges of an analog resonance: f² ∓ f f0/q − f0² = 0.
    const double half = centre / (2.0 * q), root = std::hypot(centre, half);
    CHECK(measured_gain(band, root + half) == Approx(half_power).margin(0.02));
    CHECK(measured_gain(band, root - half) == Approx(half_power).margin(0.02));
    CHECK(measured_gain(band, 12.0) - measured_gain(band, 6.0) == Approx(6.02).margin(0.1));
    CHECK(measured_gain(band, 2000.0) - measured_gain(band, 4000.0) == Approx(6.02).margin(0.3));
}

TEST_CASE("a notch removes its frequency and nothing an octave away") {
    const signal::Biquad hum{signal::notch(50.0, rate, 5.0)};
    CHECK(measured_gain(hum, 50.0) < -60.0);
    CHECK(measured_gain(hum, 100.0) == Approx(0.0).margin(0.1));
    CHECK(measured_gain(hum, 25.0) == Approx(0.0).margin(0.1));
    CHECK(measured_gain(hum, 233.0) == Approx(0.0).margin(0.01));
}

TEST_CASE("the computed response is the one that a sine meets") {
    for (const auto& c :
         {signal::lowpass(300.0, rate, 3.0), signal::highpass(80.0, rate), signal::bandpass(500.0, rate, 4.0)})
        for (const double f : {60.0, 233.0, 1000.0})
            CHECK(measured_gain(signal::Biquad{c}, f) ==
                  Approx(20.0 * std::log10(std::abs(c.response(f, rate)))).margin(0.005));
}

TEST_CASE("filters outside what the rate can carry stay stable") {
    for (const double f : {-5.0, 0.0, 24000.0, 1e9})
        for (const auto& c : {signal::lowpass(f, rate), signal::highpass(f, rate), signal::bandpass(f, rate, 0.0),
                              signal::notch(f, rate, -1.0)}) {
            signal::Biquad filter{c};
            double largest = 0.0;
            for (int i = 0; i < 20000; ++i) largest = std::max(largest, std::abs(filter(i % 7 == 0 ? 1.0 : -0.2)));
            CHECK(largest < 100.0);
        }
}

TEST_CASE("a one-pole lag is 3 dB down at its cutoff and covers 63.2 % of a step in its time constant") {
    CHECK(measured_gain(signal::OnePole::from_cutoff(100.0, rate), 100.0) == Approx(half_power).margin(0.05));
    const signal::OnePole slow = signal::OnePole::from_cutoff(20.0, rate);
    CHECK(measured_gain(slow, 400.0) - measured_gain(slow, 800.0) == Approx(6.02).margin(0.1));
    signal::OnePole lag = signal::OnePole::from_time_constant(0.01, rate);
    for (int i = 0; i < 480; ++i) lag(1.0);
    CHECK(lag.y == Approx(1.0 - std::exp(-1.0)).epsilon(1e-9));
}

TEST_CASE("an envelope rises with its attack and falls with its release") {
    signal::EnvelopeFollower envelope(0.001, 0.1, rate);
    for (int i = 0; i < 48; ++i) envelope(-2.0);
    CHECK(envelope.y == Approx(2.0 * (1.0 - std::exp(-1.0))).epsilon(1e-9));
    for (int i = 0; i < 4800; ++i) envelope(2.0);
    for (int i = 0; i < 4800; ++i) envelope(0.0);
    CHECK(envelope.y == Approx(2.0 * std::exp(-1.0)).epsilon(1e-6));
}

TEST_CASE("a ramp takes the time it is given and stays exactly on its target") {
    signal::Ramp ramp = signal::Ramp::over(1.0, 0.01, rate);
    for (int i = 0; i < 479; ++i) CHECK(ramp(1.0) < 1.0);
    ramp(1.0);
    CHECK(ramp(1.0) == 1.0);
    CHECK(ramp(1.0) == 1.0);
}

TEST_CASE("a sine oscillator does not drift: an hour of it is off by less than a billionth of a cycle") {
    signal::SineOscillator oscillator{rate};
    oscillator(233.0);
    const std::uint64_t step = oscillator.phase;
    for (int i = 1; i < 48000; ++i) oscillator(233.0);
    CHECK(oscillator.phase == step * 48000u);  // no rounding from one call to the next
    // 233 whole cycles a second: what is left over grows in proportion to the time.
    const auto off = static_cast<double>(static_cast<std::int64_t>(oscillator.phase)) * 0x1.0p-64;
    CHECK(std::abs(off) * 3600.0 < 1e-9);
}

TEST_CASE("a sine oscillator has its frequency, amplitude 1, and no jump when the frequency changes") {
    signal::SineOscillator oscillator{rate};
    double before = oscillator(100.0), largest = 0.0, jump = 0.0;
    for (int i = 1; i < 48000; ++i) {
        const double y = oscillator(i % 480 < 240 ? 100.0 : 300.0);
        largest = std::max(largest, std::abs(y));
        jump = std::max(jump, std::abs(y - before));
        before = y;
    }
    CHECK(largest == Approx(1.0).margin(1e-3));
    CHECK(jump < 2.0 * pi * 300.0 / rate * 1.01);
    signal::SineOscillator plain{rate};
    for (int i = 0; i < 48; ++i) CHECK(plain(1000.0) == Approx(std::sin(2.0 * pi * i / 48.0)).margin(1e-9));
}

TEST_CASE("a frequency that is not a number leaves the phase where it is") {
    signal::SineOscillator oscillator{rate};
    oscillator(1000.0);
    const std::uint64_t phase = oscillator.phase;
    oscillator(std::numeric_limits<double>::quiet_NaN());
    oscillator(std::numeric_limits<double>::infinity());
    CHECK(oscillator.phase == phase);
    for (int i = 0; i < 100; ++i) CHECK(std::abs(oscillator(1e300)) <= 1.0);
}
