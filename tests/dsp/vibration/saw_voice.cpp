// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_voice.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/refine_rate.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

std::vector<float> tone(double frequency, double phase, double seconds = 2.0, double rate = 48000.0) {
    std::vector<float> out(static_cast<std::size_t>(seconds * rate));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double turn = 2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate;
        out[i] = static_cast<float>(0.5 * std::sin(turn + phase));
    }
    return out;
}

/// Amplitude of the line at `frequency`, by Goertzel's recursion under a Hann window.
double goertzel(const std::vector<float>& samples, double frequency, double rate) {
    const double w = 2.0 * std::numbers::pi * frequency / rate, coefficient = 2.0 * std::cos(w);
    const auto count = static_cast<double>(samples.size());
    double s1 = 0.0, s2 = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double hann = 1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / count);
        const double s0 = samples[i] * hann + coefficient * s1 - s2;
        s2 = s1;
        s1 = s0;
    }
    return 2.0 / count * std::sqrt(std::max(0.0, s1 * s1 + s2 * s2 - coefficient * s1 * s2));
}

}  // namespace

TEST_CASE("the line of a saw lies within 0.1 Hz of the commanded rate", "[slow]") {
    const auto free_air = tone(233.0, 0.3), cutting = tone(190.0, 2.0);
    const vibration::SawRecording recordings[] = {{free_air, 48000.0, 233.0}, {cutting, 48000.0, 190.0, 7.0, true}};
    for (double rate : {160.0, 200.5, 233.0, 250.0}) {
        vibration::SawVoice voice;
        voice.prepare(48000.0, recordings);
        for (int i = 0; i < 96000; ++i) voice.tick(0.0, true, rate);
        std::vector<float> out(96000);
        for (float& y : out) y = voice.tick(0.0, true, rate);
        CHECK(vibration::refine_rate(out, 48000.0, rate, 0.01) == Approx(rate).margin(0.1));
        CHECK(voice.state() == vibration::SawState::idle);
    }
}

TEST_CASE("the envelope of a tone ripples by less than 1 dB while the load comes and goes") {
    const auto free_air = tone(233.0, 0.3), cutting = tone(233.0, 2.5);
    const vibration::SawRecording recordings[] = {{free_air, 48000.0, 233.0}, {cutting, 48000.0, 233.0, 7.0, true}};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings);
    for (int i = 0; i < 96000; ++i) voice.tick(0.0, true, 233.0);
    // A quarter cycle apart: y(t)² + y(t + T/4)² is the squared envelope.
    std::vector<double> out;
    for (int i = 0; i < 48000; ++i) out.push_back(voice.tick((i / 4800) % 2 ? 7.0 : 0.0, true, 233.0));
    const std::size_t quarter = 51;  // 48000 / 233 / 4 = 51.5
    double least = 1e9, most = 0.0;
    for (std::size_t i = 0; i + quarter < out.size(); ++i) {
        const double level = std::hypot(out[i], out[i + quarter]);
        least = std::min(least, level);
        most = std::max(most, level);
    }
    CHECK(20.0 * std::log10(most / least) < 1.0);
}

TEST_CASE("the strongest line of the voice is the commanded rate, whatever recording it is played from", "[slow]") {
    const auto slow = tone(150.0, 1.0), fast = tone(233.0, 0.3);
    const vibration::SawRecording recordings[] = {{slow, 48000.0, 150.0}, {fast, 48000.0, 233.0}};
    for (const double rate : {140.0, 165.0, 185.0, 210.0, 240.0}) {
        vibration::SawVoice voice;
        voice.prepare(48000.0, recordings);
        for (int i = 0; i < 96000; ++i) voice.tick(0.0, true, rate);
        std::vector<float> out(48000);
        for (float& y : out) y = voice.tick(0.0, true, rate);
        const double line = goertzel(out, rate, 48000.0);
        CHECK(line > 0.2);
        // The window's lobe of 1 s ends 2 Hz away; from there on there is less, also at the recorded rates.
        for (const double other : {rate - 2.0, rate + 2.0, 150.0, 233.0}) {
            CHECK(goertzel(out, other, 48000.0) < 0.05 * line);
        }
    }
}

TEST_CASE("the seam of a loop makes no step greater than those of the sound itself") {
    // 1.003 s at 233.3 Hz, with noise: no whole number of cycles, and ends that do not meet.
    std::vector<float> sound = tone(233.3, 0.4, 1.003);
    for (std::size_t i = 0; i < sound.size(); ++i) sound[i] += static_cast<float>(0.02 * Random{2}.normal(i));
    const vibration::SawRecording recordings[] = {{sound, 48000.0, 233.3}};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings);
    for (int i = 0; i < 96000; ++i) voice.tick(0.0, true, 233.3);
    double known = 0.0, heard = 0.0, before = voice.tick(0.0, true, 233.3);
    for (std::size_t i = 1; i < sound.size(); ++i) known = std::max(known, std::abs(double{sound[i]} - sound[i - 1]));
    for (int i = 0; i < 5 * 48000; ++i) {
        const double y = voice.tick(0.0, true, 233.3);
        heard = std::max(heard, std::abs(y - before));
        before = y;
    }
    CHECK(heard < 1.15 * known);
    CHECK(heard > 0.5 * known);
}

TEST_CASE("cutting begins above the upper load and ends below the lower one") {
    const auto free_air = tone(233.0, 0.3), cutting = tone(233.0, 2.5);
    const vibration::SawRecording recordings[] = {{free_air, 48000.0, 233.0}, {cutting, 48000.0, 233.0, 7.0, true}};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings);
    const auto state_at = [&](double load) {
        for (int i = 0; i < 9600; ++i) voice.tick(load, true, 233.0);
        return voice.state();
    };
    for (int i = 0; i < 48000; ++i) voice.tick(0.0, true, 233.0);
    CHECK(state_at(0.0) == vibration::SawState::idle);
    CHECK(state_at(0.4) == vibration::SawState::idle);
    CHECK(voice.loudest_recording() == 0);
    CHECK(state_at(0.6) == vibration::SawState::cutting);
    CHECK(voice.loudest_recording() == 1);
    CHECK(state_at(0.4) == vibration::SawState::cutting);
    CHECK(state_at(0.2) == vibration::SawState::idle);
    CHECK(voice.loudest_recording() == 0);
}

TEST_CASE("a recording is not played more than 15 % off its rate while a nearer one is there, and changes only once") {
    const auto slow = tone(150.0, 1.0), middle = tone(190.0, 0.0), fast = tone(233.0, 0.3);
    const vibration::SawRecording recordings[] = {
        {slow, 48000.0, 150.0}, {middle, 48000.0, 190.0}, {fast, 48000.0, 233.0}};
    const double recorded[] = {150.0, 190.0, 233.0};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings, {.spin_up_time = 0.0, .spin_down_time = 0.0});
    int changes = 0, before = 0;
    for (double rate = 140.0; rate < 250.0; rate += 0.01) {
        for (int i = 0; i < 4; ++i) voice.tick(0.0, true, rate);
        const int playing = voice.loudest_recording();
        REQUIRE(playing >= 0);
        changes += playing != before;
        before = playing;
        // Half a cross-fade later than the choice: 10 ms are 1.2 Hz here.
        REQUIRE(std::abs((rate - 1.3) / recorded[playing] - 1.0) < 0.15);
    }
    CHECK(changes == 2);
    // On a border the one that plays stays: 168.8 Hz is the geometric mean.
    for (int i = 0; i < 48000; ++i) voice.tick(0.0, true, 190.0);
    for (int i = 0; i < 48000; ++i) {
        voice.tick(0.0, true, 168.8 + 1.2 * std::sin(0.01 * i));
        REQUIRE(voice.loudest_recording() == 1);
    }
}

TEST_CASE("the voice is the same bits for the same input, and a load that is not a number counts as none") {
    const auto free_air = tone(233.0, 0.3), light = tone(190.0, 2.5), heavy = tone(190.0, 1.5);
    const vibration::SawRecording recordings[] = {
        {free_air, 48000.0, 233.0}, {light, 48000.0, 190.0, 3.0, true}, {heavy, 48000.0, 190.0, 12.0, true}};
    vibration::SawVoice one, two;
    one.prepare(48000.0, recordings);
    two.prepare(48000.0, recordings);
    const double not_numbers[] = {std::nan(""), HUGE_VAL, -HUGE_VAL};
    vibration::SawVoice copy = one;
    for (int i = 0; i < 96000; ++i) {
        const bool trigger = i < 72000;
        const double load = (i / 7000) % 3 == 1 ? 1e-4 * i : 0.0;
        const double odd = load == 0.0 ? not_numbers[i % 3] : load;
        const float y = one.tick(load, trigger, 200.0);
        REQUIRE(std::isfinite(y));
        REQUIRE(two.tick(odd, trigger, 200.0) == y);
        if (i == 30000) copy = one;  // goes on where the other is
        if (i > 30000) REQUIRE(copy.tick(load, trigger, 200.0) == y);
    }
}

TEST_CASE("a saw and its actuator do nothing in a tick that could wait") {
    const auto free_air = tone(233.0, 0.3), light = tone(190.0, 2.5), heavy = tone(150.0, 1.5);
    const vibration::SawRecording recordings[] = {
        {free_air, 48000.0, 233.0}, {light, 48000.0, 190.0, 3.0, true}, {heavy, 48000.0, 150.0, 12.0, true}};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings);
    vibration::SawVoice copy = voice;
    vibration::Actuator actuator(vibration::find_actuator("haptuator_small"), 0.1, 48000.0);
    double power = 0.0;
    const RealtimeViolations found = watch_scopes([&] {
        const RealtimeScope scope;
        for (int i = 0; i < 96000; ++i) {
            const double load = (i / 5000) % 2 ? 9.0 : 0.0, rate = 140.0 + 1e-3 * i;
            const double y = actuator(voice.tick(load, i < 80000, rate)).acceleration;
            power += y * y + copy.tick(load, i < 80000, rate);
        }
    });
    INFO(found.describe());
    CHECK(found.none());
    CHECK(power > 0.0);
}

TEST_CASE("a blade faster than all recordings has no alias above -60 dB and a level that does not fall") {
    // Harmonics up to 18 kHz, which a blade twice as fast would play at 36 kHz.
    constexpr double recorded = 228.0, rate = 48000.0;
    std::vector<float> sound(static_cast<std::size_t>(0.5 * rate));
    for (std::size_t i = 0; i < sound.size(); ++i) {
        double sum = 0.0;
        for (int k = 1; k <= 80; ++k)
            sum += std::sin(2.0 * std::numbers::pi * recorded * k * static_cast<double>(i) / rate + k * k);
        sound[i] = static_cast<float>(0.1 * sum);
    }
    const vibration::SawRecording recordings[] = {{sound, rate, recorded}};
    double before = 0.0;
    for (const double blade : {100.0, 228.0, 240.0, 252.0, 300.0, 400.0, 500.0, 600.0, 900.0, 1000.0}) {
        vibration::SawVoice voice;
        voice.prepare(rate, recordings, {.spin_up_time = 1e-4});
        for (int i = 0; i < 4800; ++i) voice.tick(0.0, true, blade);
        // A whole number of cycles of each blade: the sum of its lines is all that there should be.
        std::vector<double> y(12000);
        double power = 0.0;
        for (double& sample : y) {
            sample = voice.tick(0.0, true, blade);
            power += sample * sample / static_cast<double>(y.size());
        }
        double lines = 0.0;
        for (int k = 1; k * blade < 0.5 * rate; ++k) {
            const double w = 2.0 * std::numbers::pi * k * blade / rate, c = 2.0 * std::cos(w);
            double s1 = 0.0, s2 = 0.0;
            for (const double sample : y) {
                const double s0 = sample + c * s1 - s2;
                s2 = s1;
                s1 = s0;
            }
            const double n = static_cast<double>(y.size());
            lines += 2.0 * (s1 * s1 + s2 * s2 - c * s1 * s2) / (n * n);
        }
        const double alias = 10.0 * std::log10(std::max(power - lines, 1e-300) / power);
        CAPTURE(blade, power, alias);
        CHECK(alias < -60.0);
        CHECK(std::sqrt(power) > 0.99 * before);
        before = std::sqrt(power);
    }
}

TEST_CASE("a saw that is off is silent, and no command makes it faster than its greatest rate") {
    const auto free_air = tone(233.0, 0.3);
    const vibration::SawRecording recordings[] = {{free_air, 48000.0, 233.0}};
    vibration::SawVoice voice;
    voice.prepare(48000.0, recordings);
    for (int i = 0; i < 1000; ++i) CHECK(voice.tick(7.0, false, 233.0) == 0.0f);
    CHECK_FALSE(voice.running());
    for (const double command : {1e9, HUGE_VAL})
        for (int i = 0; i < 48000; ++i) REQUIRE(std::isfinite(voice.tick(0.0, true, command)));
    CHECK(voice.reciprocation_rate() <= vibration::BladeMotion::greatest_rate);
    CHECK(voice.reciprocation_rate() > 0.99 * vibration::BladeMotion::greatest_rate);
    for (int i = 0; i < 3 * 48000; ++i) REQUIRE(std::isfinite(voice.tick(0.0, true, std::nan(""))));
    CHECK_FALSE(voice.running());
}

TEST_CASE("a saw without usable recordings is refused") {
    vibration::SawVoice voice;
    CHECK_THROWS_AS(voice.prepare(48000.0, {}), Error);
    const auto brief = tone(233.0, 0.0, 0.03);
    const vibration::SawRecording short_one[] = {{brief, 48000.0, 233.0}};
    CHECK_THROWS_AS(voice.prepare(48000.0, short_one), Error);
    const auto good = tone(233.0, 0.0);
    const vibration::SawRecording no_rate[] = {{good, 48000.0, 0.0}},
                                  backwards[] = {{good, 48000.0, 233.0, 0, false, 1, 9, 4}};
    CHECK_THROWS_AS(voice.prepare(48000.0, no_rate), Error);
    CHECK_THROWS_AS(voice.prepare(48000.0, backwards), Error);
    const vibration::SawRecording fine[] = {{good, 48000.0, 233.0}};
    CHECK_THROWS_AS(voice.prepare(0.0, fine), Error);
}
