// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/realtime.hpp"
#include "tests/dsp/vibration/audio_rate.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using tactus::test::audio_rate;
using tactus::test::decibel;

namespace {

/// m/s² per V at a frequency, measured with a sine of 0.1 V after a second of settling.
double measured_gain(vibration::Actuator actuator, double frequency) {
    const double step = 2.0 * std::numbers::pi * frequency / audio_rate;
    std::complex<double> in = 0.0, out = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const double x = 0.1 * std::sin(step * i), y = actuator(x).acceleration;
        if (i < 48000) continue;
        in += x * std::polar(1.0, -step * i);
        out += y * std::polar(1.0, -step * i);
    }
    return std::abs(out) / std::abs(in);
}

}  // namespace

TEST_CASE("each actuator rises 12 dB per octave below its resonance, peaks there, and is flat above") {
    for (const vibration::ActuatorModel& published : vibration::actuator_models()) {
        INFO(published.name);
        // The coil's inductance tilts the far end.
        vibration::ActuatorModel model = published;
        model.inductance = 0.0;
        const vibration::Actuator actuator(model, 0.1, audio_rate);
        const vibration::ActuatorResonance resonance = vibration::resonance_on(model, 0.1);
        const double f0 = resonance.frequency;
        const double far = measured_gain(actuator, 8.0 * f0);
        CHECK(decibel(measured_gain(actuator, f0 / 8.0) / measured_gain(actuator, f0 / 16.0)) ==
              Approx(12.04).margin(0.3));
        // At f0 the resonance has 1/(2ζ) of what it has far above; 3 octaves above, its skirt is not quite over.
        const std::complex<double> s(0.0, 8.0);
        const double skirt = std::abs(s * s / (s * s + 2.0 * resonance.damping * s + 1.0));
        CHECK(measured_gain(actuator, f0) / (far / skirt) == Approx(0.5 / resonance.damping).epsilon(0.03));
        CHECK(decibel(measured_gain(actuator, 16.0 * f0) / far) == Approx(0.0).margin(1.0));
    }
}

TEST_CASE("the resonance of an actuator goes with the reduced mass of its two bodies, as its damping ratio does") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models()) {
        INFO(model.name);
        const double m = model.moving_mass;
        const auto expected = [&](double total) { return 1.0 / std::sqrt(m * (total - m) / total); };
        for (const double total : {0.010, 0.020, 0.050, 0.3, 10.0}) {
            const double f0 = vibration::resonance_on(model, total).frequency;
            CHECK(f0 / model.resonance == Approx(expected(total) / expected(model.resonance_mass)));
            // The greatest of gain / f² is, without damping, at f0; with damping ζ at f0 √(1 − 2ζ²).
            const double damping = vibration::resonance_on(model, total).damping;
            const vibration::Actuator actuator(model, total, audio_rate);
            double best = 0.0, greatest = 0.0;
            for (double f = 0.3 * f0; f < 2.0 * f0; f += 0.1)
                if (const double g = actuator.gain(f) / (f * f); g > greatest) greatest = g, best = f;
            CHECK(best == Approx(f0 * std::sqrt(1.0 - 2.0 * damping * damping)).margin(0.02 * f0));
        }
    }
}

TEST_CASE(
    "the coil's back-EMF raises its impedance at the resonance, and a blocked coil's current is volts over ohms") {
    const vibration::ActuatorModel& model = vibration::find_actuator("markII_D");
    const vibration::ActuatorMechanics mechanics = vibration::mechanics_of(model);
    const auto impedance = [&](double frequency) {
        vibration::Actuator actuator(model, 0.1, audio_rate);
        std::complex<double> volts = 0.0, amperes = 0.0;
        const double step = 2.0 * std::numbers::pi * frequency / audio_rate;
        for (int i = 0; i < 96000; ++i) {
            const vibration::ActuatorOutput out = actuator(0.1 * std::sin(step * i));
            if (i < 48000) continue;
            volts += out.voltage * std::polar(1.0, -step * i);
            amperes += out.current * std::polar(1.0, -step * i);
        }
        return std::abs(volts / amperes);
    };
    CHECK(impedance(2.0) == Approx(model.resistance).epsilon(0.01));
    CHECK(impedance(65.0) ==
          Approx(model.resistance + mechanics.force_factor * mechanics.force_factor / mechanics.damping).epsilon(0.02));
    CHECK(impedance(800.0) ==
          Approx(std::hypot(model.resistance, 2.0 * std::numbers::pi * 800.0 * model.inductance)).epsilon(0.02));
}

TEST_CASE("an actuator on a handle takes no more power than its amplifier gives") {
    // Electrical energy in less heat in the coil and the dampers is what the two bodies hold; it is never negative.
    const vibration::ActuatorModel& model = vibration::find_actuator("haptuator_large");
    vibration::Actuator actuator(model, 0.3, audio_rate);
    double energy = 0.0;
    for (int i = 0; i < 48000; ++i) {
        const double drive = i < 24000 ? 3.0 * std::sin(0.01 * i + 1e-6 * i * i) : 0.0;
        const vibration::ActuatorOutput out = actuator(drive);
        energy += (out.voltage * out.current - model.resistance * out.current * out.current) / audio_rate;
        REQUIRE(energy > -1e-6);
    }
}

TEST_CASE("the computed gain of an actuator is the one that a sine meets") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models()) {
        const vibration::Actuator actuator(model, 0.05, audio_rate);
        for (const double f : {40.0, 89.0, 233.0, 700.0})
            CHECK(actuator.gain(f) == Approx(measured_gain(actuator, f)).epsilon(1e-3));
    }
}

TEST_CASE("far above the resonance, acceleration goes as one over the mass of the handle and the housing") {
    for (const vibration::ActuatorModel& model : vibration::actuator_models()) {
        const double m = model.moving_mass;
        CHECK(measured_gain(vibration::Actuator(model, 0.1, audio_rate), 900.0) ==
              Approx((0.3 - m) / (0.1 - m) * measured_gain(vibration::Actuator(model, 0.3, audio_rate), 900.0))
                  .epsilon(0.005));
    }
}

TEST_CASE("a haptuator shakes 20 g by 2.5 g peak at 150 Hz and 1 V, as its data sheet says") {
    for (const char* name : {"haptuator_small", "haptuator_large"})
        CHECK(measured_gain(vibration::Actuator(vibration::find_actuator(name), 0.020, audio_rate), 150.0) ==
              Approx(24.5).epsilon(0.005));
}

TEST_CASE("on a heavy handle an actuator shakes less, and its resonance falls") {
    const vibration::ActuatorModel& model = vibration::find_actuator("haptuator_small");
    const double m = model.moving_mass;
    const auto shape = [&](double mass) {
        const vibration::ActuatorResonance at = vibration::resonance_on(model, mass);
        const std::complex<double> s(0.0, 150.0 / at.frequency);
        return std::abs(s * s / (s * s + 2.0 * at.damping * s + 1.0));
    };
    CHECK(vibration::Actuator(model, 0.300, audio_rate).gain(150.0) ==
          Approx(24.5 * (0.020 - m) / (0.300 - m) * shape(0.300) / shape(0.020)).epsilon(0.005));
}

TEST_CASE("Mark II-D shakes 100 g by 8 g peak to peak at 65 Hz and its current limit, as its data sheet says") {
    vibration::ActuatorModel model = vibration::find_actuator("markII_D");
    model.voltage_limit = 100.0;  // the back-EMF asks for more than R i
    vibration::Actuator actuator(model, 0.1, audio_rate);
    const vibration::ActuatorMechanics mechanics = vibration::mechanics_of(model);
    const double impedance = model.resistance + mechanics.force_factor * mechanics.force_factor / mechanics.damping;
    double largest = 0.0, current = 0.0;
    for (int i = 0; i < 96000; ++i) {
        const double drive = model.current_limit * impedance * std::sin(2.0 * std::numbers::pi * 65.0 * i / audio_rate);
        const vibration::ActuatorOutput out = actuator(drive);
        if (i < 48000) continue;
        largest = std::max(largest, std::abs(out.acceleration));
        current = std::max(current, std::abs(out.current));
    }
    CHECK(current == Approx(0.5).epsilon(0.02));
    CHECK(2.0 * largest == Approx(8.0 * 9.80665).epsilon(0.02));
}

TEST_CASE("the amplifier holds the current at its limit, whatever the voltage asked for") {
    vibration::ActuatorModel model = vibration::find_actuator("haptuator_large");
    model.voltage_limit = 30.0;
    vibration::Actuator actuator(model, 0.1, audio_rate);
    double most = 0.0;
    for (int i = 0; i < 48000; ++i) {
        const vibration::ActuatorOutput out = actuator((i / 300) % 2 ? 30.0 : -30.0);
        most = std::max(most, std::abs(out.current));
        REQUIRE(std::abs(out.voltage) <= 30.0);
    }
    for (int i = 0; i < 1000; ++i) REQUIRE(std::abs(actuator(i % 2 ? 1e6 : -1e6).voltage) <= 30.0);
    CHECK(most == Approx(model.current_limit).epsilon(1e-9));
}

TEST_CASE("after the drive ends an actuator comes to rest and never computes with denormal numbers") {
    flush_denormals_to_zero();
    vibration::Actuator actuator(vibration::find_actuator("haptuator_small"), 0.1, audio_rate);
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
    vibration::Actuator bad(vibration::find_actuator("haptuator_small"), 0.1, audio_rate), good = bad;
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
    CHECK_THROWS_AS(vibration::Actuator(model, 0.0, audio_rate), Error);
    CHECK_THROWS_AS(vibration::Actuator(model, 0.1, 0.0), Error);
    CHECK_THROWS_AS(vibration::Actuator(model, 0.1, 100.0), Error);
    CHECK_THROWS_WITH(vibration::Actuator(model, 0.004, audio_rate), ContainsSubstring("4.4 g of moving mass"));
    vibration::ActuatorModel strong = model;
    strong.reference_acceleration = 60.0;
    CHECK_THROWS_WITH(vibration::Actuator(strong, 0.1, audio_rate), ContainsSubstring("back-EMF"));
    CHECK_THROWS_WITH(vibration::find_actuator("haptuator_smal"), ContainsSubstring("haptuator_small"));
}
