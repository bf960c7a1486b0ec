// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/modelled_saw.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "dsp/vibration/saw_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace tactus;
using vibration::SawModelSize;

namespace {

constexpr double played_rate = 48000.0;

/// A saw of known parts: orders 1 to 4 and noise in a band around 700 Hz that swells twice per stroke.
struct Parts {
    double first = 20.0, second = 8.0, third = 4.0, fourth = 2.0;  // rms
    double noise = 6.0;                                            // rms
};

std::vector<float> saw(double strokes, const Parts& parts, std::uint64_t seed, double seconds = 4.0) {
    const auto count = static_cast<std::size_t>(seconds * played_rate);
    const Random random{seed};
    std::vector<double> noise(count, 0.0);
    const double radius = 0.985, angle = 2.0 * pi * 700.0 / played_rate;
    double power = 0.0;
    for (std::size_t i = 2; i < count; ++i) {
        const double phase = 2.0 * pi * strokes * static_cast<double>(i) / played_rate;
        noise[i] = std::abs(std::sin(phase)) * random.normal(i) + 2.0 * radius * std::cos(angle) * noise[i - 1] -
                   radius * radius * noise[i - 2];
        power += noise[i] * noise[i] / static_cast<double>(count);
    }
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double phase = 2.0 * pi * strokes * static_cast<double>(i) / played_rate;
        const double orders = parts.first * std::cos(phase) + parts.second * std::cos(2.0 * phase + 1.0) +
                              parts.third * std::cos(3.0 * phase - 2.0) + parts.fourth * std::cos(4.0 * phase + 0.5);
        out[i] = static_cast<float>(std::numbers::sqrt2 * orders + parts.noise / std::sqrt(power) * noise[i]);
    }
    return out;
}

vibration::SawRecording recording(const std::vector<float>& samples, double strokes, double load,
                                  double density = 0.0) {
    vibration::SawRecording out{samples, played_rate, strokes, load, load > 0.0};
    out.density = density;
    return out;
}

/// Rms of the part of `samples` within 3 Hz of `frequency`.
double line(const std::vector<float>& samples, double frequency) {
    double re = 0.0, im = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t = static_cast<double>(i) / played_rate;
        const double hann = 1.0 - std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(samples.size()));
        re += hann * samples[i] * std::cos(2.0 * pi * frequency * t);
        im += hann * samples[i] * std::sin(2.0 * pi * frequency * t);
        weights += hann;
    }
    return std::numbers::sqrt2 * std::hypot(re, im) / weights;
}

std::vector<float> play(const vibration::SawModel& model, double load, double strokes, double density = 0.0,
                        double seconds = 4.0) {
    vibration::ModelledSaw voice;
    voice.prepare(played_rate, model);
    for (int i = 0; i < 48000; ++i) voice.tick(load, density, true, strokes);
    std::vector<float> out(static_cast<std::size_t>(seconds * played_rate));
    for (float& y : out) y = voice.tick(load, density, true, strokes);
    return out;
}

double rms(const std::vector<float>& samples) {
    double power = 0.0;
    for (const float x : samples) power += static_cast<double>(x) * x / static_cast<double>(samples.size());
    return std::sqrt(power);
}

}  // namespace

TEST_CASE("the model of a saw has the orders, the noise and the swell that the recording was made of") {
    const auto samples = saw(150.0, {}, 1);
    const vibration::SawRecording one[] = {recording(samples, 150.5, 7.0)};
    const vibration::SawModel model = vibration::fit_saw_model(one);
    const vibration::SawCondition& condition = model.conditions.front();
    CHECK(condition.rate == Approx(150.0).margin(0.01));
    CHECK(condition.sound.orders[0] == Approx(20.0).epsilon(0.01));
    CHECK(condition.sound.orders[1] == Approx(8.0).epsilon(0.01));
    CHECK(condition.sound.orders[2] == Approx(4.0).epsilon(0.02));
    CHECK(condition.sound.orders[3] == Approx(2.0).epsilon(0.1));
    CHECK(condition.sound.residual == Approx(6.0).epsilon(0.04));
    // |sin φ| squared is 1/2 − cos(2φ)/2: the power's second order is −1 in the phase of the recording. Phases are told
    // by the first order, a cosine.
    CHECK(condition.sound.swell_cos[1] == Approx(-1.0).margin(0.1));
    CHECK(condition.sound.swell_cos[0] == Approx(0.0).margin(0.1));
    // The excitation is known to about half a sample at 8 kHz: 0.1 rad of the second order.
    CHECK(condition.sound.swell_sin[1] == Approx(0.0).margin(0.2));
    const auto wrapped = [](double angle) { return std::remainder(angle, 2.0 * pi); };
    CHECK(wrapped(model.phases[1] - 2.0 * model.phases[0] - 1.0) == Approx(0.0).margin(0.02));
    CHECK(wrapped(model.phases[2] - 3.0 * model.phases[0] + 2.0) == Approx(0.0).margin(0.05));
}

TEST_CASE("the model plays what it was fitted to") {
    const auto samples = saw(150.0, {}, 1);
    const vibration::SawRecording one[] = {recording(samples, 150.0, 7.0)};
    const auto played = play(vibration::fit_saw_model(one), 7.0, 150.0);
    for (const double order : {1.0, 2.0, 3.0})
        CHECK(line(played, 150.0 * order) == Approx(line(samples, 150.0 * order)).epsilon(0.05));
    CHECK(rms(played) == Approx(rms(samples)).epsilon(0.03));
    // The noise lies around 700 Hz and swells twice per stroke: its spectrum, bin by bin.
    signal::WelchSettings settings;
    settings.segment = 8192;
    settings.overlap = 4096;
    const auto here = signal::welch<float>(played, settings), there = signal::welch<float>(samples, settings);
    for (const double band : {500.0, 650.0, 800.0, 1000.0}) {
        double ours = 0.0, theirs = 0.0;
        for (std::size_t k = 0; k < here.power.size(); ++k)
            if (std::abs(here.frequency(k) - band) < 70.0) {
                ours += here.power[k];
                theirs += there.power[k];
            }
        CHECK(10.0 * std::log10(ours / theirs) == Approx(0.0).margin(1.0));
    }
}

TEST_CASE("the fundamental of a modelled saw is the commanded rate") {
    const auto slow = saw(150.0, {}, 1), fast = saw(233.0, {40.0, 16.0, 8.0, 4.0, 9.0}, 2);
    const vibration::SawRecording two[] = {recording(slow, 150.0, 7.0), recording(fast, 233.0, 7.0)};
    const vibration::SawModel model = vibration::fit_saw_model(two);
    for (const double strokes : {120.0, 150.0, 187.3, 233.0, 260.0}) {
        const auto played = play(model, 7.0, strokes, 0.0, 2.0);
        const double at = line(played, strokes);
        CHECK(at > 5.0 * line(played, strokes - 4.0));
        CHECK(at > 5.0 * line(played, strokes + 4.0));
    }
}

TEST_CASE("between recorded loads, densities and rates the levels of a model are the means, and outside they stay") {
    const auto a = saw(150.0, {10.0, 4.0, 2.0, 1.0, 3.0}, 1), b = saw(150.0, {20.0, 8.0, 4.0, 2.0, 6.0}, 2),
               c = saw(225.0, {45.0, 18.0, 9.0, 4.5, 9.0}, 3);
    const vibration::SawRecording three[] = {recording(a, 150.0, 3.0), recording(b, 150.0, 9.0),
                                             recording(c, 225.0, 9.0)};
    const vibration::SawSounds sounds(vibration::fit_saw_model(three));
    const auto first = [&](double strokes, double load) { return sounds.at(true, strokes, load, 0.0).orders[0]; };
    CHECK(first(150.0, 3.0) == Approx(10.0).epsilon(0.01));
    CHECK(first(150.0, 5.0) == Approx(10.0 + 10.0 / 3.0).epsilon(0.01));
    CHECK(first(150.0, 20.0) == Approx(20.0).epsilon(0.01));
    // 45 at 225 Hz is 20 at 150 Hz, scaled by the square of the rate; so it is in between.
    CHECK(first(180.0, 9.0) == Approx(20.0 * 1.2 * 1.2).epsilon(0.01));
    CHECK(first(75.0, 9.0) == Approx(5.0).epsilon(0.01));
    CHECK(first(400.0, 9.0) == Approx(45.0).epsilon(0.01));
    CHECK(sounds.at(true, 187.5, 9.0, 0.0).residual == Approx(7.5).epsilon(0.05));

    const vibration::SawRecording bones[] = {recording(a, 150.0, 7.0, 600.0), recording(b, 150.0, 7.0, 1800.0)};
    const vibration::SawSounds by_density(vibration::fit_saw_model(bones));
    CHECK(by_density.at(true, 150.0, 7.0, 900.0).orders[0] == Approx(12.5).epsilon(0.01));
    CHECK(by_density.at(true, 150.0, 7.0, 3000.0).orders[0] == Approx(20.0).epsilon(0.01));
    CHECK(by_density.at(true, 150.0, 7.0, 0.0).orders[0] == Approx(15.0).epsilon(0.01));
    CHECK(by_density.covers(true, 150.0, 7.0, 900.0));
    CHECK_FALSE(by_density.covers(true, 150.0, 7.0, 2000.0));
    CHECK_FALSE(by_density.covers(true, 160.0, 7.0, 900.0));
}

TEST_CASE("cutting under a vanishing load sounds like free air, and without free air it is 12 dB softer") {
    const auto idle = saw(150.0, {5.0, 2.0, 1.0, 0.5, 0.5}, 1), cut = saw(150.0, {}, 2);
    const vibration::SawRecording both[] = {recording(idle, 150.0, 0.0), recording(cut, 150.0, 8.0)};
    const vibration::SawSounds sounds(vibration::fit_saw_model(both));
    CHECK(sounds.at(true, 150.0, 0.0, 0.0).orders[0] == Approx(5.0).epsilon(0.01));
    CHECK(sounds.at(true, 150.0, 4.0, 0.0).orders[0] == Approx(12.5).epsilon(0.01));
    const vibration::SawRecording alone[] = {recording(cut, 150.0, 8.0)};
    const vibration::SawSounds cutting(vibration::fit_saw_model(alone));
    CHECK(cutting.at(false, 150.0, 0.0, 0.0).orders[0] == Approx(5.0).epsilon(0.01));
    CHECK(cutting.at(true, 150.0, 1.0, 0.0).orders[0] == Approx(20.0).epsilon(0.01));
}

TEST_CASE("no change of rate, load, density or trigger makes a step in a modelled saw") {
    // Orders only: whatever jumps then is a step.
    const Parts soft{10.0, 4.0, 0.0, 0.0, 0.0}, hard{30.0, 12.0, 0.0, 0.0, 0.0};
    const auto idle = saw(150.0, soft, 1), cut = saw(150.0, hard, 2), fast = saw(233.0, hard, 3);
    const vibration::SawRecording some[] = {recording(idle, 150.0, 0.0), recording(cut, 150.0, 8.0, 1000.0),
                                            recording(fast, 233.0, 8.0, 1500.0)};
    vibration::ModelledSaw voice;
    voice.prepare(played_rate, vibration::fit_saw_model(some));
    // The steepest that orders 1 and 2 can be at 233 Hz, and the start of the blade.
    const double greatest = 2.0 * pi * 233.0 / played_rate * std::numbers::sqrt2 * (30.0 + 2.0 * 12.0);
    double before = 0.0, steepest = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const int part = i / 4800;
        const double y =
            voice.tick(part % 2 ? 8.0 : 0.0, part % 3 ? 1500.0 : 700.0, part % 7 != 6, part % 5 < 3 ? 150.0 : 233.0);
        steepest = std::max(steepest, std::abs(y - before));
        before = y;
    }
    CHECK(steepest < 1.1 * greatest);
    CHECK(steepest > 0.3 * greatest);
}

TEST_CASE("a modelled saw that is off is silent, and bad input is no sound") {
    const auto samples = saw(150.0, {}, 1);
    const vibration::SawRecording one[] = {recording(samples, 150.0, 7.0)};
    const vibration::SawModel model = vibration::fit_saw_model(one);
    vibration::ModelledSaw voice;
    voice.prepare(played_rate, model);
    for (int i = 0; i < 1000; ++i) CHECK(voice.tick(7.0, 0.0, false, 233.0) == 0.0f);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 48000; ++i) REQUIRE(std::isfinite(voice.tick(nan, nan, true, i % 2 ? nan : 1e300)));
    for (int i = 0; i < 96000; ++i) voice.tick(0.0, 0.0, false, 0.0);
    CHECK(voice.tick(0.0, 0.0, false, 0.0) == 0.0f);
    CHECK_THROWS_AS(voice.prepare(1000.0, model), Error);
    CHECK_THROWS_AS(voice.prepare(played_rate, {}), Error);
}

TEST_CASE("a modelled saw neither allocates nor waits") {
    const auto samples = saw(150.0, {}, 1, 1.0);
    const vibration::SawRecording one[] = {recording(samples, 150.0, 7.0)};
    vibration::ModelledSaw voice;
    voice.prepare(played_rate, vibration::fit_saw_model(one));
    const RealtimeViolations found = watch([&] {
        for (int i = 0; i < 4800; ++i) voice.tick(i % 9 > 4 ? 7.0 : 0.0, 1000.0, i % 100 > 4, 150.0 + i % 80);
    });
    INFO(found.describe());
    CHECK(found.none());
}

TEST_CASE("recordings that no model can be made of are refused") {
    const auto samples = saw(150.0, {}, 1, 0.1);
    const vibration::SawRecording brief[] = {recording(samples, 150.0, 7.0)};
    CHECK_THROWS_WITH(vibration::fit_saw_model(brief), Catch::Matchers::ContainsSubstring("too short"));
    CHECK_THROWS_AS(vibration::fit_saw_model({}), Error);
    const auto whole = saw(150.0, {}, 1);
    const vibration::SawRecording half[] = {recording(whole, 150.0, 7.0, 900.0), recording(whole, 150.0, 8.0)};
    CHECK_THROWS_WITH(vibration::fit_saw_model(half), Catch::Matchers::ContainsSubstring("density"));
}
