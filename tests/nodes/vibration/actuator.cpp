// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Peak of an output in the second half of a second of a tone.
double peak(NodeHarness& node, const std::string& output, double frequency, double amplitude) {
    node.feed<float>("drive", [=](std::int64_t k) {
        return static_cast<float>(amplitude *
                                  std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(k) / 48000.0));
    });
    node.prepare();
    node.run(48000);
    const auto samples = node.values<float>(output);
    float largest = 0.0f;
    for (std::size_t i = 24000; i < samples.size(); ++i) largest = std::max(largest, std::abs(samples[i]));
    return static_cast<double>(largest);
}

}  // namespace

TEST_CASE("an actuator node shakes as its data sheet says, in inverse proportion to the mass above resonance") {
    const vibration::ActuatorModel& model = vibration::find_actuator("haptuator_large");
    NodeHarness light("actuator"), heavy("actuator");
    for (NodeHarness* node : {&light, &heavy}) node->set("preset", "haptuator_large").set("gain", "2 V");
    light.set("mass", "20 g");
    heavy.set("mass", "40 g");
    const double expected = vibration::Actuator(model, 0.02, 48000.0).gain(150.0);
    const double measured = peak(light, "signal", 150.0, 0.5);
    CHECK(measured == Approx(expected).epsilon(0.02));
    // Above resonance nearly as one over the mass of the housing, which is the total less the moving mass.
    CHECK(peak(heavy, "signal", 150.0, 0.5) ==
          Approx(vibration::Actuator(model, 0.04, 48000.0).gain(150.0)).epsilon(0.02));
    CHECK(peak(heavy, "signal", 150.0, 0.5) < 0.55 * measured);
}

TEST_CASE("a resonance that is given holds on this handle, and the current is told") {
    NodeHarness node("actuator");
    node.set("preset", "markII_D").set("mass", "300 g").set("resonance", "80 Hz");
    const double low = peak(node, "current", 80.0, 0.1);
    NodeHarness off("actuator");
    off.set("preset", "markII_D").set("mass", "300 g").set("resonance", "80 Hz");
    const double high = peak(off, "current", 400.0, 0.1);
    // Back-EMF: the current is least at the resonance.
    CHECK(low < 0.7 * high);
    CHECK(high == Approx(0.1 / 4.5).epsilon(0.02));
}

TEST_CASE("an actuator node cuts the voltage at the amplifier's limit and counts it") {
    NodeHarness node("actuator");
    node.set("voltage_limit", "1.5 V").set("current_limit", "10 A");
    CHECK(peak(node, "voltage", 100.0, 20.0) == Approx(1.5));
    CHECK(std::get<double>(node.report().sections.at("node").at("limited_samples")) > 10000.0);
}

TEST_CASE("an actuator whose resonance does not fit under half the rate is refused") {
    NodeHarness node("actuator", {.period = flicks_per_second / 1000});
    node.set("resonance", "600 Hz");
    CHECK_THROWS_AS(node.prepare(), Error);
}
