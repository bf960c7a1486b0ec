// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/exposure.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;
using analysis::ExposureVerdict;

TEST_CASE("a lower bound of an exposure never gives a verdict that it is low enough") {
    for (double a8 = 0.0; a8 < 8.0; a8 += 0.1) {
        CAPTURE(a8);
        const ExposureVerdict whole = analysis::judge_exposure(a8, signal::hand_arm_limits, false),
                              bound = analysis::judge_exposure(a8, signal::hand_arm_limits, true);
        CHECK(whole == (a8 > 5.0   ? ExposureVerdict::above_limit
                        : a8 > 2.5 ? ExposureVerdict::above_action
                                   : ExposureVerdict::below_action));
        CHECK(bound == (a8 > 5.0   ? ExposureVerdict::above_limit
                        : a8 > 2.5 ? ExposureVerdict::at_least_above_action
                                   : ExposureVerdict::cannot_be_judged));
    }
}

TEST_CASE("one axis of three, a band that ends at 100 Hz and a clipped record make a lower bound") {
    analysis::ExposureOperation one;
    one.three_axes = true;
    CHECK_FALSE(one.is_lower_bound());
    analysis::ExposureOperation axis = one, band = one, clipped = one;
    axis.three_axes = false;
    band.band_high = 100.0;
    clipped.clipped = 1;
    CHECK(axis.is_lower_bound());
    CHECK(band.is_lower_bound());
    CHECK(clipped.is_lower_bound());
}
