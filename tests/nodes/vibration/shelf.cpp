// SPDX-License-Identifier: Apache-2.0
// Filters, dynamics, transients and sounds of the shelf against their formulas.
#include "assets/sound/sound.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

using namespace tactus;
using test::NodeHarness;
using Complex = std::complex<double>;

namespace {

constexpr double shelf_rate = 48000.0;

/// Complex gain of what a node makes of an impulse, by the definition of Fourier's transform.
Complex gain_of(const std::vector<float>& impulse, double frequency) {
    Complex sum = 0.0;
    for (std::size_t k = 0; k < impulse.size(); ++k)
        sum += static_cast<double>(impulse[k]) *
               std::polar(1.0, -2.0 * pi * frequency / shelf_rate * static_cast<double>(k));
    return sum;
}

NodeHarness& impulse(NodeHarness& node, std::int64_t count = 48000) {
    node.feed<float>("in", [](std::int64_t k) { return k == 0 ? 1.0f : 0.0f; });
    node.prepare();
    node.run(count);
    return node;
}

/// s of the analog prototype, normalised to the corner, for a frequency after the bilinear transform.
Complex warped(double frequency, double corner) {
    return {0.0, std::tan(pi * frequency / shelf_rate) / std::tan(pi * corner / shelf_rate)};
}

}  // namespace

TEST_CASE("every filter kind has the response of its analog prototype") {
    const double corner = 1000.0, q = 1.3, boost = 4.0, a = std::sqrt(boost), r = std::sqrt(a);
    const auto check = [&](const char* kind, const std::function<Complex(Complex)>& prototype) {
        NodeHarness node("filter");
        node.set("kind", kind).set("frequency", "1 kHz").set("q", "1.3").set("boost", "4");
        const auto response = impulse(node).values<float>("out");
        for (const double f : {20.0, 300.0, 700.0, 1000.0, 1500.0, 6000.0, 20000.0}) {
            const Complex given = gain_of(response, f), wanted = prototype(warped(f, corner));
            CAPTURE(kind, f, std::abs(given), std::abs(wanted));
            CHECK(std::abs(given - wanted) < 1e-4);
        }
    };
    const auto below = [=](Complex s) { return s * s + s / q + 1.0; };
    check("lowpass", [&](Complex s) { return 1.0 / below(s); });
    check("highpass", [&](Complex s) { return s * s / below(s); });
    check("bandpass", [&](Complex s) { return s / q / below(s); });
    check("notch", [&](Complex s) { return (s * s + 1.0) / below(s); });
    check("peak", [&](Complex s) { return (s * s + s * a / q + 1.0) / (s * s + s / (a * q) + 1.0); });
    check("low_shelf", [&](Complex s) { return a * (s * s + r * s / q + a) / (a * s * s + r * s / q + 1.0); });
    check("high_shelf", [&](Complex s) { return a * (a * s * s + r * s / q + 1.0) / (s * s + r * s / q + a); });
    check("allpass", [&](Complex s) { return (s * s - s / q + 1.0) / below(s); });
}

TEST_CASE("one pole and state variable have the responses of their analog prototypes") {
    for (const bool is_high : {false, true}) {
        NodeHarness node("one_pole");
        node.set("kind", is_high ? "highpass" : "lowpass").set("frequency", "500 Hz");
        const auto response = impulse(node).values<float>("out");
        for (const double f : {20.0, 500.0, 3000.0, 20000.0}) {
            const Complex s = warped(f, 500.0);
            CHECK(std::abs(gain_of(response, f) - (is_high ? s : 1.0) / (1.0 + s)) < 1e-4);
        }
    }
    NodeHarness node("state_variable");
    node.set("frequency", "2 kHz").set("q", "3");
    impulse(node);
    for (const double f : {50.0, 1500.0, 2000.0, 2600.0, 15000.0}) {
        const Complex s = warped(f, 2000.0), below = s * s + s / 3.0 + 1.0;
        CHECK(std::abs(gain_of(node.values<float>("low"), f) - 1.0 / below) < 1e-4);
        CHECK(std::abs(gain_of(node.values<float>("band"), f) - s / 3.0 / below) < 1e-4);
        CHECK(std::abs(gain_of(node.values<float>("high"), f) - s * s / below) < 1e-4);
        CHECK(std::abs(gain_of(node.values<float>("notch"), f) - (s * s + 1.0) / below) < 1e-4);
    }
}

TEST_CASE("a comb has the response of its delayed sums") {
    NodeHarness node("comb");
    node.set("time", "2 ms").set("forward", "0.5").set("back", "-0.7");
    const auto response = impulse(node).values<float>("out");
    for (const double f : {10.0, 125.0, 250.0, 333.0, 5000.0}) {
        const Complex z = std::polar(1.0, -2.0 * pi * f * 96.0 / shelf_rate);
        CHECK(std::abs(gain_of(response, f) - (1.0 + 0.5 * z) / (1.0 + 0.7 * z)) < 1e-4);
    }
}

TEST_CASE("a compressor leaves what is quiet and turns dB above its threshold into a ratio-th of them") {
    for (const double level : {0.05, 0.1, 0.2, 0.8, 3.0}) {
        NodeHarness node("compressor");
        node.set("threshold", "0.1").set("ratio", "3").set("makeup", "2");
        node.feed<float>("in", [=](std::int64_t) { return static_cast<float>(level); });
        node.prepare();
        node.run(48000);
        const double above_dB = std::max(0.0, 20.0 * std::log10(level / 0.1));
        CHECK(node.last<double>("gain") == Approx(std::pow(10.0, -above_dB * (1.0 - 1.0 / 3.0) / 20.0)).epsilon(1e-3));
        CHECK(static_cast<double>(node.last<float>("out")) ==
              Approx(2.0 * level * node.last<double>("gain")).epsilon(1e-6));
    }
}

TEST_CASE("a tap rings as its formula says, in proportion to the speed, and taps add up") {
    NodeHarness node("impact");
    node.set("frequency", "200 Hz").set("decay", "20 ms").set("amplitude", "50 1/s").set("most", "1000 m/s^2");
    node.feed<bool>("hit", [](std::int64_t k) { return k >= 120 && (k < 480 || k >= 1992); });
    node.feed<double>("speed", [](std::int64_t k) { return k < 1008 ? -0.3 : 0.1; });
    node.prepare();
    node.run(6000);
    const auto out = node.values<float>("out");
    const auto ring = [](double t) { return t < 0.0 ? 0.0 : std::exp(-t / 20e-3) * std::sin(2.0 * pi * 200.0 * t); };
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double t = static_cast<double>(k) / shelf_rate;
        CHECK(static_cast<double>(out[k]) ==
              Approx(15.0 * ring(t - 120.0 / shelf_rate) + 5.0 * ring(t - 1992.0 / shelf_rate)).margin(1e-5));
    }
    NodeHarness hard("impact");
    hard.set("most", "3 m/s^2").feed("hit", true).feed("speed", 1e9);
    hard.prepare();
    hard.run(4800);
    for (const float x : hard.values<float>("out")) CHECK(std::abs(x) <= 3.0f);
}

TEST_CASE("a player plays its sound once per trigger, and fades out what still plays") {
    auto made = std::make_shared<sound::Sound>(sound::Sound{48000, 1, 1000, {}});
    for (std::size_t k = 0; k < 1000; ++k) made->samples.push_back(1.0f + static_cast<float>(k));
    NodeHarness node("player");
    node.asset("sound", made).set("gain", "0.5").set("fade", "1 ms");
    node.feed<bool>("trigger", [](std::int64_t k) { return (k >= 72 && k < 120) || (k >= 456 && k < 5040); });
    node.prepare();
    node.run(3000);
    const auto out = node.values<float>("out");
    const auto playing = node.values<bool>("playing");
    CHECK(out[71] == 0.0f);
    for (std::size_t k = 72; k < 456; ++k) CHECK(out[k] == 0.5f * static_cast<float>(k - 71));
    // 48 samples of fading, beside the sound from its beginning.
    CHECK(out[480] == Approx(0.5 * 25.0 + 0.5 * 409.0 * (1.0 - 25.0 / 48.0)));
    for (std::size_t k = 504; k < 1456; ++k) CHECK(out[k] == 0.5f * static_cast<float>(k - 455));
    CHECK(out[1456] == 0.0f);
    CHECK(playing[1455]);
    CHECK_FALSE(playing[1456]);
}

TEST_CASE("a player that is triggered again and again does not click") {
    // Rises to 1 within 100 samples and stays.
    auto made = std::make_shared<sound::Sound>(sound::Sound{48000, 1, 4800, {}});
    for (std::size_t k = 0; k < 4800; ++k) made->samples.push_back(std::min(1.0f, 0.01f * static_cast<float>(k)));
    for (const std::int64_t apart : {48, 72, 144}) {
        NodeHarness node("player");
        node.asset("sound", made).set("fade", "10 ms");
        node.feed<bool>("trigger", [=](std::int64_t k) { return k < 2400 && k % apart < apart / 2; });
        node.prepare();
        node.run(9600);
        const auto out = node.values<float>("out");
        float most = 0.0f;
        // The sound ends with a step of its own.
        for (std::size_t k = 1; k < 6000; ++k) most = std::max(most, std::abs(out[k] - out[k - 1]));
        CAPTURE(apart, most);
        CHECK(most < 0.15f);
        CHECK(*std::max_element(out.begin(), out.end()) > 0.3f);
    }
}

TEST_CASE("a player converts the rate of its sound") {
    auto made = std::make_shared<sound::Sound>(sound::Sound{24000, 2, 2400, {}});
    for (std::size_t k = 0; k < 2400; ++k)
        for (const double side : {0.5, 1.5})
            made->samples.push_back(
                static_cast<float>(side * std::sin(2.0 * pi * 440.0 * static_cast<double>(k) / 24000.0)));
    NodeHarness node("player");
    node.asset("sound", made).feed("trigger", true);
    node.prepare();
    node.run(4800);
    const auto out = node.values<float>("out");
    for (std::size_t k = 500; k < 4300; ++k)
        CHECK(static_cast<double>(out[k]) ==
              Approx(std::sin(2.0 * pi * 440.0 * static_cast<double>(k) / shelf_rate)).margin(2e-3));
}

TEST_CASE("a ramp goes from one value to the other in its time, again at each trigger") {
    NodeHarness node("ramp", {.period = flicks_per_second / 1000});
    node.set("from", "2").set("to", "-2").set("time", "100 ms");
    node.feed<bool>("trigger", [](std::int64_t k) { return k == 50 || k == 300; });
    node.prepare();
    node.run(450);
    const auto out = node.values<double>("out");
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double since = k < 50 ? 0.0 : static_cast<double>(k < 300 ? k - 50 : k - 300) * 1e-3;
        CHECK(out[k] == Approx(2.0 - 4.0 * std::min(since / 0.1, 1.0)).margin(1e-12));
    }
    CHECK(node.values<bool>("done")[150]);
    CHECK_FALSE(node.values<bool>("done")[149]);
    CHECK_FALSE(node.values<bool>("done")[300]);
    NodeHarness gentle("ramp", {.period = flicks_per_second / 1000});
    gentle.set("shape", "smooth").feed<bool>("trigger", [](std::int64_t k) { return k == 0; });
    gentle.prepare();
    gentle.run(251);
    CHECK(gentle.last<double>("out") == Approx(0.5 - 0.5 * std::cos(0.25 * pi)));
}
