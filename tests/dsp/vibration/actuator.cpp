// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/realtime.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double rate = 48000.0;

/// m/s² per V at a frequency, measured with a sine of 0.1 V after a second of settling.
double measured_gain(vibration::Actuator actuator, double frequency) {
    const double step = 2.0 * std::numbers::pi * frequency / rate;
    std::complex<double> in = 0.0, out = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const double x = 0.1 * std::sin(step * i), y = actuator(x).acceleration;
        if (i < 48000) continue;
        in += x * std::polar(1.0, -step * i);
        out += y * std::polar(1.0, -step * i);
    }
    return std::abs(out) / std::abs(in);
}

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

}  // namespace

TEST_CASE("each actuator rises 12 dB per octave below its resonance, peaks there, and is flat above") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models()) {
        INFO(model.name);
        const vibration::Actuator actuator(model, 0.1, rate);
        const double f0 = model.resonance;
        const double far = measured_gain(actuator, 8.0 * f0);
        CHECK(decibel(measured_gain(actuator, f0 / 8.0) / measured_gain(actuator, f0 / 16.0)) ==
              Approx(12.04).margin(0.3));
        // At f0 the resonance has 1/(2ζ) of what it has far above; 3 octaves above, its skirt is not quite over.
        const std::complex<double> s(0.0, 8.0);
        const double skirt = std::abs(s * s / (s * s + 2.0 * model.damping * s + 1.0));
        CHECK(measured_gain(actuator, f0) / (far / skirt) == Approx(0.5 / model.damping).epsilon(0.03));
        CHECK(decibel(measured_gain(actuator, 16.0 * f0) / far) == Approx(0.0).margin(1.0));
    }
}

TEST_CASE("the computed gain of an actuator is the one that a sine meets") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models()) {
        const vibration::Actuator actuator(model, 0.05, rate);
        for (const double f : {40.0, 89.0, 233.0, 700.0})
            CHECK(actuator.gain(f) == Approx(measured_gain(actuator, f)).epsilon(1e-3));
    }
}

TEST_CASE("acceleration goes as one over the mass") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models())
        CHECK(measured_gain(vibration::Actuator(model, 0.1, rate), 300.0) ==
              Approx(3.0 * measured_gain(vibration::Actuator(model, 0.3, rate), 300.0)).epsilon(1e-9));
}

TEST_CASE("Mark II-D shakes 100 g by 8 g peak to peak at 65 Hz and its current limit, as its data sheet says") {
    const vibration::ActuatorModel& model = vibration::find_actuator("markII_D");
    vibration::Actuator actuator(model, 0.1, rate);
    double largest = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const double drive = actuator.greatest_voltage() * std::sin(2.0 * std::numbers::pi * 65.0 * i / rate);
        const vibration::ActuatorOutput out = actuator(drive);
        CHECK_FALSE(out.limited);
        if (i > 48000) largest = std::max(largest, std::abs(out.acceleration));
    }
    CHECK(2.0 * largest == Approx(8.0 * 9.80665).epsilon(0.02));
}

TEST_CASE("after the drive ends an actuator comes to rest and never computes with denormal numbers") {
    flush_denormals_to_zero();
    vibration::Actuator actuator(vibration::find_actuator("haptuator_small"), 0.1, rate);
    for (int i = 0; i < 4800; ++i) actuator(2.0);
    double last = 1.0;
    bool denormal = false;
    for (int i = 0; i < 20 * 48000; ++i) {
        last = std::abs(actuator(0.0).acceleration);
        denormal = denormal || std::fpclassify(last) == FP_SUBNORMAL;
    }
    CHECK(last < 1e-12);
    CHECK_FALSE(denormal);
}

TEST_CASE("a drive that is not a number counts as none and does not stay") {
    vibration::Actuator bad(vibration::find_actuator("haptuator_small"), 0.1, rate), good = bad;
    for (int i = 0; i < 1000; ++i) {
        const bool odd = i % 3 == 0;
        const double x = std::sin(0.05 * i);
        const vibration::ActuatorOutput a =
            bad(odd ? (i % 2 ? std::nan("") : std::numeric_limits<double>::infinity()) : x);
        const vibration::ActuatorOutput b = good(odd ? 0.0 : x);
        REQUIRE(a.acceleration == b.acceleration);
        REQUIRE(a.voltage == b.voltage);
    }
}

TEST_CASE("an actuator that cannot be is refused, an unknown one with the known names") {
    const vibration::ActuatorModel& model = vibration::find_actuator("haptuator_small");
    CHECK_THROWS_AS(vibration::Actuator(model, 0.0, rate), Error);
    CHECK_THROWS_AS(vibration::Actuator(model, 0.1, 0.0), Error);
    CHECK_THROWS_AS(vibration::Actuator(model, 0.1, 100.0), Error);
    CHECK_THROWS_WITH(vibration::find_actuator("haptuator_smal"), ContainsSubstring("haptuator_small"));
}
