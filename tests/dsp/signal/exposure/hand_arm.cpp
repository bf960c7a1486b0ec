// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>

using namespace tactus;

TEST_CASE("daily exposure agrees with the norm's examples to the printed digit") {
    const auto printed = [](double x) { return std::round(10.0 * x) / 10.0; };
    CHECK(printed(signal::daily_exposure(std::array{signal::HandArmOperation{7.4, 2.5 * 3600.0}})) == 4.1);
    CHECK(printed(signal::daily_exposure(std::array{signal::HandArmOperation{4.6, 7200.0},
                                                    signal::HandArmOperation{6.0, 3600.0},
                                                    signal::HandArmOperation{3.6, 7200.0}})) == 3.6);
    CHECK(std::round(signal::years_to_white_fingers(7.0)) == 4.0);
    // A sagittal saw on bone: 11.3 m/s², 23 minutes to the action value, 94 to the limit value.
    CHECK(signal::time_to_reach(signal::hand_arm_limits.action, 11.3) / 60.0 == Approx(23.5).margin(0.05));
    CHECK(signal::time_to_reach(signal::hand_arm_limits.limit, 11.3) / 60.0 == Approx(94.0).margin(0.05));
    CHECK(printed(signal::vibration_total(std::array{1.0, 10.3, 4.2})) == Approx(11.2));
    CHECK(signal::time_to_reach(signal::hand_arm_limits.limit, 0.0) == std::numeric_limits<double>::infinity());
}
