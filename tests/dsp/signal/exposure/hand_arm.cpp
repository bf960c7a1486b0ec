// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

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

TEST_CASE("the filter is within 0.5 % of the definition from 6.3 to 1250 Hz at 20 kHz, within 0.1 % from 44.1 kHz on") {
    for (const auto& [rate, deviation] :
         {std::pair(20000.0, 0.005), {44100.0, 0.001}, {48000.0, 0.001}, {96000.0, 5e-4}}) {
        const signal::HandArmFilter filter(rate);
        for (double f = 2.0; f < 2000.0; f *= 1.05) {
            const double ratio = std::abs(filter.response(f)) / std::abs(signal::hand_arm_weighting(f));
            CAPTURE(rate, f);
            if (f >= 6.3 && f <= 1250.0) CHECK(std::abs(ratio - 1.0) < deviation);
            else CHECK(std::abs(ratio - 1.0) < 0.02);
        }
    }
}

TEST_CASE("filter and transform agree within 0.5 % from one second and 20 kHz on, whatever offset the record has") {
    for (const double rate : {20000.0, 48000.0})
        for (const double seconds : {1.0, 1.37, 5.0})
            for (const double frequency : {8.0, 31.5, 125.0, 233.0, 1000.0}) {
                CAPTURE(rate, seconds, frequency);
                std::vector<double> x(static_cast<std::size_t>(seconds * rate));
                for (std::size_t i = 0; i < x.size(); ++i)
                    x[i] = -9.81 + 10.0 * std::cos(2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate);
                signal::WeightedRecord record(rate, -9.81);
                record.push(std::span(x).first(x.size() / 3));
                record.push(std::span(x).subspan(x.size() / 3));
                record.end_piece();
                CHECK(record.by_filter() == Approx(record.by_transform()).epsilon(0.005));
                const double wanted = 10.0 / std::numbers::sqrt2 * std::abs(signal::hand_arm_weighting(frequency));
                CHECK(record.by_transform() == Approx(wanted).epsilon(frequency < 20.0 ? 0.02 : 0.005));
            }
}

TEST_CASE("a gap parts the record: no step between its pieces is weighted") {
    std::vector<double> x(96000);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = std::sin(2.0 * std::numbers::pi * 100.0 * static_cast<double>(i) / 48000.0);
    signal::WeightedRecord whole(48000.0, 0.0), parted(48000.0, 0.0);
    whole.push(x);
    whole.end_piece();
    parted.push(std::span(x).first(48000));
    parted.end_piece();
    parted.push(std::span(x).subspan(48000));
    parted.end_piece();
    CHECK(parted.by_transform() == Approx(whole.by_transform()).epsilon(0.005));
    CHECK(parted.by_filter() == Approx(parted.by_transform()).epsilon(0.002));
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
