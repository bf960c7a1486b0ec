// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

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

TEST_CASE("an actuator of given force factor, mass, resonance and Q is that of its formula, whatever the preset") {
    // Far above resonance a blocked coil pushes the housing: a = Bl V / (R (M - m)); at resonance Q times as much.
    constexpr double factor = 1.5, ohms = 8.0, total = 0.2, m = 0.04, q = 4.0, f0 = 60.0;
    for (const char* preset : {"haptuator_small", "lra_10mm"}) {
        const auto make = [&](NodeHarness& node) {
            node.set("preset", preset).set("force_factor", "1.5 N/A").set("resistance", "8 ohm").set("mass", "200 g");
            node.set("moving_mass", "40 g").set("q", "4").set("resonance", "60 Hz").set("inductance", "0.001 mH");
            node.set("voltage_limit", "10 V").set("current_limit", "5 A");
        };
        NodeHarness at_resonance("actuator"), above("actuator"), limited("actuator");
        make(at_resonance);
        make(above);
        make(limited);
        const double far = factor / (ohms * (total - m));
        CHECK(peak(at_resonance, "signal", f0, 1.0) == Approx(q * far).epsilon(0.02));
        CHECK(peak(above, "signal", 12.0 * f0, 1.0) == Approx(far).epsilon(0.02));
        // 0.3 N are 0.2 A, which 8 ohm have at 1.6 V.
        limited.set("force_limit", "0.3 N");
        CHECK(peak(limited, "current", 12.0 * f0, 8.0) == Approx(0.2).epsilon(0.02));
    }
}

TEST_CASE("an actuator that cannot be is refused with the numbers that were given") {
    const auto refusal = [](std::initializer_list<std::pair<const char*, const char*>> values) -> std::string {
        NodeHarness node("actuator");
        for (const auto& [name, value] : values) node.set(name, value);
        try {
            node.prepare();
        } catch (const Error& error) {
            return error.message();
        }
        return "";
    };
    const std::string damped =
        refusal({{"force_factor", "9 N/A"}, {"resistance", "3 ohm"}, {"resonance", "80 Hz"}, {"damping", "0.2"}});
    CHECK(damped.find("9 N/A") != std::string::npos);
    CHECK(damped.find("3 ohm") != std::string::npos);
    CHECK(damped.find("0.2") != std::string::npos);
    CHECK(refusal({{"moving_mass", "300 g"}, {"force_factor", "1 N/A"}, {"resonance", "80 Hz"}, {"damping", "0.9"}})
              .find("300 g") != std::string::npos);
    CHECK(refusal({{"q", "3"}, {"damping", "0.2"}}).find("not both") != std::string::npos);
    CHECK(refusal({{"preset", "erm_coin"}, {"resonance", "90 Hz"}}).find("'resonance' does not apply") !=
          std::string::npos);
}

TEST_CASE("a rotating mass shakes at the rate at which it turns, with m r w^2 / M") {
    NodeHarness node("actuator");
    node.set("preset", "erm_coin").set("mass", "100 g");
    node.feed<float>("drive", [](std::int64_t) { return 3.0f; });
    node.prepare();
    node.run(48000);
    const auto samples = node.values<float>("signal");
    int rises = 0;
    float largest = 0.0f;
    for (std::size_t i = 24001; i < samples.size(); ++i) {
        rises += samples[i - 1] < 0.0f && samples[i] >= 0.0f;
        largest = std::max(largest, samples[i]);
    }
    CHECK(rises == Approx(75.0).margin(1.0));  // 9000 turns a minute in half a second
    CHECK(largest == Approx(0.75 * 9.80665).epsilon(0.01));
    NodeHarness slow("actuator");
    slow.set("preset", "erm_coin");
    slow.feed<float>("drive", [](std::int64_t) { return 1.5f; });  // below what it needs to start
    slow.prepare();
    slow.run(4800);
    for (const float x : slow.values<float>("signal")) REQUIRE(x == 0.0f);
}
