// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/refine_rate.hpp"

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

/// Five orders that fall off as 1/k, and white noise of the given rms.
std::vector<float> buzz(double frequency, double noise, double rate, double seconds = 1.0) {
    std::vector<float> out(static_cast<std::size_t>(seconds * rate));
    for (std::size_t i = 0; i < out.size(); ++i) {
        double y = noise * Random{3}.normal(i);
        for (int k = 1; k <= 5; ++k)
            y += 0.3 / k * std::sin(2.0 * std::numbers::pi * k * frequency * static_cast<double>(i) / rate + 0.7 * k);
        out[i] = static_cast<float>(y);
    }
    return out;
}

}  // namespace

TEST_CASE("the rate of a buzz of one second is heard to 0.06 Hz, whatever the sample rate, in silence and in noise") {
    for (const double sample_rate : {22050.0, 44100.0, 48000.0, 96000.0})
        for (const double frequency : {75.0, 152.3, 233.0, 333.3})
            for (const double noise : {0.0, 0.1}) {
                INFO(sample_rate << " Hz, " << frequency << " Hz, noise " << noise);
                const signal::FundamentalEstimate heard =
                    signal::find_fundamental(buzz(frequency, noise, sample_rate), sample_rate);
                CHECK(heard.frequency == Approx(frequency).margin(0.06));
                CHECK(heard.is_certain());
            }
}

TEST_CASE("noise, silence and a constant have no rate worth the name") {
    std::vector<float> noise(48000);
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(Random{seed}.normal(i));
        CHECK_FALSE(signal::find_fundamental(noise, 48000.0).is_certain());
    }
    for (const std::vector<float>& quiet : {std::vector<float>(48000), std::vector<float>(48000, 0.5f),
                                            std::vector<float>(50, 0.5f), std::vector<float>()})
        CHECK(signal::find_fundamental(quiet, 48000.0).frequency == 0.0);
}

TEST_CASE("a rate stated 2 % off is corrected from the sound to 0.02 Hz") {
    const std::vector<float> sound = buzz(190.4, 0.05, 48000.0, 2.0);
    for (const double stated : {187.0, 190.0, 194.0})
        CHECK(vibration::refine_rate(sound, 48000.0, stated, 0.02) == Approx(190.4).margin(0.02));
    // Too short to say anything: what was stated stays.
    CHECK(vibration::refine_rate(std::span(sound).first(500), 48000.0, 187.0, 0.02) == 187.0);
}
