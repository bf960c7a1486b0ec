// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using test::NodeHarness;

namespace {

float tone(double frequency, std::int64_t k) {
    return static_cast<float>(std::sin(2.0 * pi * frequency * static_cast<double>(k) / 48000.0));
}

/// Root mean square of the last second.
double level(const std::vector<float>& samples) {
    double sum = 0.0;
    for (std::size_t i = samples.size() - 48000; i < samples.size(); ++i) sum += std::pow(samples[i], 2.0);
    return std::sqrt(sum / 48000.0);
}

double gain_at(const std::string& kind, double frequency) {
    NodeHarness node("filter");
    node.set("kind", kind).set("frequency", "1 kHz");
    node.feed<float>("in", [=](std::int64_t k) { return tone(frequency, k); });
    node.prepare();
    node.run(2 * 48000);
    return level(node.values<float>("out")) * std::sqrt(2.0);
}

}  // namespace

TEST_CASE("a sine has the frequency, amplitude and phase that it is given, a minute on as well") {
    NodeHarness node("sine");
    node.set("frequency", "440.5 Hz").set("amplitude", "0.25").set("phase", "90 deg");
    node.prepare();
    node.run(60 * 48000);
    const auto samples = node.values<float>("signal");
    for (std::size_t i = 0; i < samples.size(); i += i < 1000 ? 1 : 4999)
        REQUIRE(samples[i] ==
                Approx(0.25 * std::cos(2.0 * pi * 440.5 * static_cast<double>(i) / 48000.0)).margin(1e-6));
}

TEST_CASE("a mix is the sum of the connected signals times their gains") {
    NodeHarness node("mix", {.any = &value::signal});
    node.disconnect_optional();
    NodeHarness two("mix", {.any = &value::signal});
    for (const char* open : {"in2", "in3", "in4", "in5", "in6", "in7"}) two.disconnect(open);
    two.feed("in1", 0.5f).feed("in8", -2.0f);
    two.set("gain1", "3").set("gain8", "0.25");
    node.prepare();
    two.prepare();
    node.run(100);
    two.run(100);
    CHECK(node.last<float>("out") == 0.0f);
    CHECK(two.last<float>("out") == 1.0f);
}

TEST_CASE("a filter passes its band, is 3 dB down at the edge and falls 12 dB per octave") {
    CHECK(gain_at("lowpass", 50.0) == Approx(1.0).epsilon(0.01));
    CHECK(gain_at("lowpass", 1000.0) == Approx(std::sqrt(0.5)).epsilon(0.001));
    CHECK(gain_at("lowpass", 4000.0) / gain_at("lowpass", 2000.0) == Approx(0.25).epsilon(0.1));
    CHECK(gain_at("highpass", 8000.0) == Approx(1.0).epsilon(0.01));
    CHECK(gain_at("highpass", 1000.0) == Approx(std::sqrt(0.5)).epsilon(0.001));
    CHECK(gain_at("bandpass", 1000.0) == Approx(1.0).epsilon(0.001));
    CHECK(gain_at("notch", 1000.0) < 1e-4);
}

TEST_CASE("a filter whose frequency changes live keeps running") {
    NodeHarness node("filter", {.drive_params = true});
    node.prepare();
    node.run(48000);
    CHECK(node.finite());
}

TEST_CASE("an envelope rises and falls with its time constants") {
    NodeHarness node("envelope");
    node.set("attack", "10 ms").set("release", "100 ms");
    node.feed<float>("in", [](std::int64_t k) { return k < 4800 ? -2.0f : 0.0f; });
    node.prepare();
    node.run(48000);
    const auto out = node.values<float>("out");
    CHECK(out[479] == Approx(2.0 * (1.0 - std::exp(-1.0))).epsilon(1e-3));
    CHECK(out[4799] == Approx(2.0).epsilon(1e-3));
    CHECK(out[4799 + 4800] == Approx(out[4799] * std::exp(-1.0)).epsilon(1e-3));
    CHECK(node.last<double>("level") == Approx(out.back()));
}

TEST_CASE("a mix takes what can be added on each of its inputs, and nothing else") {
    const compile::Catalogue types = nodes::catalogue();
    const auto mix = std::ranges::find(types, "mix", &NodeType::name);
    struct Inputs final : MemberVisitor {
        void input(std::string_view name, Input& port) override {
            INFO(name);
            CHECK(port.takes == kinds::addable);
            ++count;
        }
        int count = 0;
    } inputs;
    void* const node = (*mix)->create();
    (*mix)->visit(node, inputs);
    (*mix)->destroy(node);
    CHECK(inputs.count == 8);
}
