// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;

TEST_CASE("the weighting has the values of its definition in the norm") {
    // |H| at 10^(n/10) Hz, n = 8 … 31.
    constexpr std::array wanted{.72721, .87310, .95140, .95759, .89581, .78198, .64708, .51917,
                                .41111, .32439, .25605, .20239, .16021, .12696, .10068, .07988,
                                .06338, .05026, .03980, .03137, .02447, .01862, .01346, .00894};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double frequency = std::pow(10.0, (8.0 + static_cast<double>(i)) / 10.0);
        CHECK(std::abs(std::abs(signal::hand_arm_weighting(frequency)) - wanted[i]) < 6e-6);
    }
    CHECK(std::abs(signal::hand_arm_weighting(500.0 / (2.0 * std::numbers::pi))) == Approx(0.2020).margin(5e-5));
    CHECK(std::abs(signal::hand_arm_weighting(233.0)) == Approx(0.06835).margin(5e-6));
}

TEST_CASE("as a filter at 44.1 and 48 kHz it is within 0.3 % from 6.3 to 1000 Hz, in the norm's tolerance everywhere") {
    for (const double rate : {44100.0, 48000.0, 96000.0}) {
        const signal::HandArmFilter filter(rate);
        for (double f = 2.0; f < 2000.0; f *= 1.05) {
            const double ratio = std::abs(filter.response(f)) / std::abs(signal::hand_arm_weighting(f));
            CAPTURE(rate, f);
            if (f >= 6.3 && f <= 1000.0) CHECK(std::abs(ratio - 1.0) < 0.003);
            if (f >= 10.0 && f <= 794.0) {
                CHECK(ratio < 1.12);
                CHECK(ratio > 0.89);
            } else {
                CHECK(ratio < 1.26);
                CHECK(ratio > 0.79);
            }
        }
    }
}

TEST_CASE("through the spectrum a tone is weighted within 0.01 %, through the filter within 0.3 %") {
    for (const double frequency : {8.0, 31.5, 125.0, 233.0, 1000.0}) {
        std::vector<double> x(96000);
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = 10.0 * std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(i) / 48000.0);
        signal::WelchSettings settings;
        settings.segment = 48000;
        settings.overlap = 24000;
        const double wanted = 10.0 / std::numbers::sqrt2 * std::abs(signal::hand_arm_weighting(frequency));
        // Near 8 Hz the curve bends most within the window's main lobe.
        CHECK(signal::weighted_acceleration(signal::welch<double>(x, settings)) ==
              Approx(wanted).epsilon(frequency < 20.0 ? 1e-3 : 1e-4));
        signal::HandArmFilter filter(48000.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double y = filter(x[i]);
            if (i >= 48000) sum += y * y;
        }
        CHECK(std::sqrt(sum / 48000.0) == Approx(wanted).epsilon(0.003));
    }
}

TEST_CASE("daily exposure agrees with the norm's examples to the printed digit") {
    const auto printed = [](double x) { return std::round(10.0 * x) / 10.0; };
    CHECK(printed(signal::daily_exposure(std::array{signal::HandArmOperation{7.4, 2.5 * 3600.0}})) == 4.1);
    CHECK(printed(signal::daily_exposure(std::array{signal::HandArmOperation{4.6, 7200.0},
                                                    signal::HandArmOperation{6.0, 3600.0},
                                                    signal::HandArmOperation{3.6, 7200.0}})) == 3.6);
    CHECK(std::round(signal::years_to_white_fingers(7.0)) == 4.0);
    // A sagittal saw on bone: 11.3 m/s², 23 minutes to the action value, 94 to the limit value.
    CHECK(signal::time_to_reach(signal::action_value, 11.3) / 60.0 == Approx(23.5).margin(0.05));
    CHECK(signal::time_to_reach(signal::limit_value, 11.3) / 60.0 == Approx(94.0).margin(0.05));
    CHECK(printed(signal::vibration_total(std::array{1.0, 10.3, 4.2})) == Approx(11.2));
    CHECK(signal::time_to_reach(signal::limit_value, 0.0) == std::numeric_limits<double>::infinity());
}
