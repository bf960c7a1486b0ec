// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_voice.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/fundamental.hpp"

#include <catch2/catch.hpp>

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

}  // namespace

TEST_CASE("the line of a saw lies within 0.1 Hz of the commanded rate") {
    const auto free_air = tone(233.0, 0.3), cutting = tone(190.0, 2.0);
    const SawRecording recordings[] = {{free_air, 48000.0, 233.0}, {cutting, 48000.0, 190.0, 7.0, true}};
    for (double rate : {160.0, 200.5, 233.0, 250.0}) {
        SawVoice voice;
        voice.prepare(48000.0, recordings);
        for (int i = 0; i < 96000; ++i) voice.tick(0.0, true, rate);
        std::vector<float> out(96000);
        for (float& y : out) y = voice.tick(0.0, true, rate);
        CHECK(refine_rate(out, 48000.0, rate, 0.01) == Approx(rate).margin(0.1));
        CHECK(voice.state() == SawState::idle);
    }
}

TEST_CASE("the envelope of a tone ripples by less than 1 dB while the load comes and goes") {
    const auto free_air = tone(233.0, 0.3), cutting = tone(233.0, 2.5);
    const SawRecording recordings[] = {{free_air, 48000.0, 233.0}, {cutting, 48000.0, 233.0, 7.0, true}};
    SawVoice voice;
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

TEST_CASE("an actuator shows its data sheet's acceleration and bounds voltage and current") {
    const ActuatorModel& model = find_actuator("haptuator_small");
    CHECK(Actuator(model, 0.020, 48000.0).gain(150.0) == Approx(24.5).epsilon(0.01));
    CHECK(3.0 * Actuator(model, 0.300, 48000.0).gain(150.0) == Approx(4.9).epsilon(0.01));
    Actuator actuator(model, 0.3, 48000.0);
    for (int i = 0; i < 1000; ++i) {
        const ActuatorOutput out = actuator(i % 2 ? 1e6 : -1e6);
        CHECK(std::abs(out.voltage) <= model.voltage_limit);
        CHECK(std::abs(out.current) <= model.current_limit);
    }
}
