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

TEST_CASE("a lower limit brings down a value that is larger or on its way there, and no change passes it") {
    constexpr Flicks period = flicks_per_second / 1000;
    const std::int64_t length = run::ParamRamps::length(period);
    Param param("1 N", "0 N", "10 N");
    run::ParamRamp ramp(param);
    ramp.newest_plan = 2;
    run::ParamRamps ramps(period);
    ramps.set(param, &ramp, 8.0, 0, length, 1);
    ramps.advance(0);
    ramps.limit(param, &ramp, 3.0, 1, length, 2);
    ramps.advance(length + 1);
    CHECK(param == 3.0);
    ramps.set(param, &ramp, 8.0, length + 2, 0, 2);
    CHECK(param == 3.0);
    ramps.set(param, &ramp, 2.0, length + 3, 0, 2);
    ramps.limit(param, &ramp, 2.5, length + 3, length, 2);
    ramps.advance(length + 4);
    CHECK(param == 2.0);
}
