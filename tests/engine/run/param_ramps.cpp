// SPDX-License-Identifier: Apache-2.0
#include "engine/run/param_ramps.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("a parameter that is set at once while it comes in keeps what it was set to") {
    constexpr Flicks period = flicks_per_second / 1000;
    Param param("1 N", "0 N", "10 N");
    run::ParamRamp ramp(param);
    ramp.newest_plan = 1;
    run::ParamRamps ramps(period);
    ramps.set(param, &ramp, 2.0, 0, run::ParamRamps::length(period), 1);
    ramps.advance(0);
    REQUIRE(param > 1.0);
    REQUIRE(param < 2.0);
    // No force depends on it in the plan that is to come, which knows no ramp of it.
    ramps.set(param, nullptr, 5.0, 1, run::ParamRamps::length(period), 1);
    ramps.advance(1);
    CHECK(param == 5.0);
    ramps.keep(2);
    CHECK(param == 5.0);
}
