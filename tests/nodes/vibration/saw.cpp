// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Root mean square of samples first … first + 0.2 s.
double level(const std::vector<float>& samples, std::size_t first) {
    double sum = 0.0;
    for (std::size_t i = first; i < first + 9600; ++i) sum += std::pow(static_cast<double>(samples[i]), 2.0);
    return std::sqrt(sum / 9600.0);
}

/// The teeth alone: a model's sound with them less the sound without, over 1 s at `strokes`, after half a second.
std::vector<double> teeth_alone(double strokes, double stroke, double pitch, double force, double mass) {
    std::vector<double> alone;
    for (const double n : {force, 0.0}) {
        NodeHarness node("saw");
        node.set("blade_rate", std::to_string(strokes) + " Hz")
            .set("voice", "model")
            .disconnect("trigger")
            .disconnect("contact");
        node.disconnect("density").set("mass", std::to_string(mass) + " kg");
        node.feed<double>("load", [](std::int64_t) { return 7.0; });
        node.feed<double>("tooth_force", [n](std::int64_t) { return n; });
        node.feed<double>("teeth", [](std::int64_t) { return 4.0; });
        const double passing = std::numbers::pi * strokes * stroke / pitch;
        node.feed<double>("passing", [passing](std::int64_t) { return passing; });
        node.prepare();
        node.run(72000);
        const auto signal = node.values<float>("signal");
        if (alone.empty()) alone.assign(signal.begin() + 24000, signal.end());
        else
            for (std::size_t i = 0; i < alone.size(); ++i) alone[i] -= static_cast<double>(signal[24000 + i]);
    }
    return alone;
}

double amplitude(const std::vector<double>& samples, double hz) {
    double re = 0.0, im = 0.0;
    const auto count = static_cast<double>(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double hann = 1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / count);
        re += hann * samples[i] * std::cos(2.0 * std::numbers::pi * hz * static_cast<double>(i) / 48000.0);
        im += hann * samples[i] * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / 48000.0);
    }
    return 2.0 * std::hypot(re, im) / count;
}

}  // namespace

TEST_CASE("in a model the line of the passing teeth follows the speed of the stroke over the tooth pitch") {
    // The beat is cos(β sin φ)·cos φ with β = speed/(pitch·rate): its strongest order of the stroke is the odd one next
    // below β, where the blade is near its greatest speed.
    for (const auto& [strokes, stroke, pitch] :
         {std::tuple{120.0, 3e-3, 1.411e-3}, std::tuple{228.0, 3e-3, 1.411e-3}, std::tuple{300.0, 3e-3, 1.411e-3},
          std::tuple{228.0, 3e-3, 0.94e-3}, std::tuple{228.0, 5e-3, 1.411e-3}}) {
        const std::vector<double> alone = teeth_alone(strokes, stroke, pitch, 4.0, 0.5);
        double strongest = 0.0, at = 0.0, sum = 0.0;
        for (int order = 1; order <= 20; ++order) {
            const double level = amplitude(alone, order * strokes);
            if (level > strongest) {
                strongest = level;
                at = order * strokes;
            }
        }
        for (const double x : alone) sum += x * x / static_cast<double>(alone.size());
        const double speed = std::numbers::pi * strokes * stroke;  // at mid-stroke
        CAPTURE(strokes, stroke, pitch, at, strongest, speed / pitch);
        CHECK(at > 0.65 * speed / pitch);
        CHECK(at < 1.05 * speed / pitch);
        // A tooth's share of 1 N on 0.5 kg: 2 m/s² at most.
        CHECK(std::sqrt(sum) == Approx(1.0).epsilon(0.15));
        CHECK(amplitude(alone, 1.5 * speed / pitch) < 0.1 * strongest);
    }
}

TEST_CASE("in a model teeth that are out of the bone are silent, and half the force is half the sound") {
    const auto rms = [](const std::vector<double>& x) {
        double sum = 0.0;
        for (const double v : x) sum += v * v;
        return std::sqrt(sum / static_cast<double>(x.size()));
    };
    CHECK(rms(teeth_alone(228.0, 3e-3, 1.411e-3, 0.0, 0.5)) == 0.0);
    const double one = rms(teeth_alone(228.0, 3e-3, 1.411e-3, 4.0, 0.5));
    CHECK(rms(teeth_alone(228.0, 3e-3, 1.411e-3, 2.0, 0.5)) == Approx(0.5 * one).epsilon(1e-3));
}

TEST_CASE("a saw spins up to its rate while the trigger is held, and stops after") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz").disconnect("load").disconnect("contact");
    node.feed<bool>("trigger", [](std::int64_t k) { return k < 48000; });
    node.prepare();
    node.run(3 * 48000);
    const auto rate = node.values<double>("rate");
    CHECK(rate[0] < 10.0);
    CHECK(rate[47999] == Approx(200.0).epsilon(0.01));
    CHECK(rate.back() == Approx(0.0).margin(1.0));
    CHECK(node.values<bool>("running")[47999]);
    CHECK_FALSE(node.last<bool>("running"));
    CHECK(node.last<float>("signal") == 0.0f);
}

TEST_CASE("a saw with no trigger wire always runs, and cuts louder than it idles") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz").disconnect("trigger").disconnect("contact");
    node.feed<double>("load", [](std::int64_t k) { return k < 48000 ? 0.0 : 7.0; });
    node.prepare();
    node.run(2 * 48000);
    const auto signal = node.values<float>("signal");
    // The sample recordings: 20 and 50 m/s² of a fundamental with 30 % of its octave.
    const double shape = std::sqrt((1.0 + 0.09) / 2.0);
    CHECK(level(signal, 36000) == Approx(20.0 * shape).epsilon(0.05));
    CHECK(level(signal, 84000) == Approx(50.0 * shape).epsilon(0.05));
}

TEST_CASE("a saw that is told of its contact sounds as one that cuts in exactly that time") {
    for (const char* voice : {"recordings", "model"}) {
        NodeHarness node("saw");
        node.set("blade_rate", "200 Hz").set("voice", voice).set("spin_up", "0 ms").disconnect("trigger");
        node.disconnect("density").feed<double>("load", [](std::int64_t k) { return k < 24000 ? 7.0 : 0.1; });
        node.feed<bool>("contact", [](std::int64_t k) { return k >= 12000 && k < 36000; });
        node.prepare();
        node.run(48000);
        const auto cutting = node.values<bool>("cutting");
        CHECK(std::count(cutting.begin(), cutting.end(), true) == 24000);
        CHECK(cutting[12000]);
        CHECK_FALSE(cutting[11999]);
        CHECK_FALSE(cutting[36000]);
    }
}

TEST_CASE("a saw played as a model has the levels and the rate of its recordings") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz")
        .set("voice", "model")
        .disconnect("trigger")
        .disconnect("density")
        .disconnect("contact");
    node.feed<double>("load", [](std::int64_t k) { return k < 48000 ? 0.0 : 7.0; });
    node.prepare();
    node.run(2 * 48000);
    const auto signal = node.values<float>("signal");
    const double shape = std::sqrt((1.0 + 0.09) / 2.0);
    CHECK(level(signal, 36000) == Approx(20.0 * shape).epsilon(0.05));
    CHECK(level(signal, 84000) == Approx(50.0 * shape).epsilon(0.05));
    CHECK(node.last<double>("rate") == Approx(200.0).epsilon(0.01));
    CHECK(node.last<bool>("running"));
}
