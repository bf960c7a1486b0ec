// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/sampled_wall.hpp"

#include "dsp/core/random.hpp"
#include "dsp/simulate/device_model.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using control::SampledWall;

TEST_CASE("the passivity border by motion meets the bound of Colgate and Schenkel") {
    for (const double rate : {500.0, 1000.0, 4000.0})
        for (const double viscous : {0.5, 2.0, 10.0})
            for (const double share : {0.0, 0.2, 0.5, 0.8}) {
                SampledWall wall;
                wall.period = 1.0 / rate;
                wall.viscous = viscous;
                wall.damping = share * viscous;
                INFO(rate << " Hz, b " << viscous << ", B " << wall.damping);
                CHECK(control::passive_stiffness(wall) ==
                      Approx(2.0 * (viscous - wall.damping) / wall.period).epsilon(0.1));
            }
    // A negative damping costs as much; a wall more damped than the device is not passive at all.
    SampledWall wall;
    wall.damping = -0.4;
    CHECK(control::passive_stiffness(wall) == Approx(1200.0).epsilon(0.1));
    wall.damping = 1.1;
    CHECK(control::passive_stiffness(wall) < 1.0);
    // A delay takes as much as half a period takes.
    wall = {};
    wall.delay = 1e-3;
    CHECK(control::passive_stiffness(wall) == Approx(1.0 / 1.5e-3).epsilon(0.1));
}

TEST_CASE("inside of the conditions of Abbott and Okamura and of Diolaiti nothing oscillates") {
    const Random random{5};
    for (std::uint64_t i = 0; i < 60; ++i) {
        const auto between = [&](double low, double high, std::uint64_t which) {
            return low * std::pow(high / low, random.uniform(8 * i + which));
        };
        SampledWall wall;
        wall.period = i % 2 == 0 ? 1e-3 : 0.25e-3;
        wall.delay = i % 3 == 0 ? wall.period : 0.0;
        wall.mass = between(0.05, 0.5, 0);
        wall.viscous = between(0.5, 10.0, 1);
        wall.resolution = between(5e-6, 60e-6, 2);
        wall.friction = between(0.02, 0.5, 3);
        wall.stiffness = 0.9 * control::quiet_stiffness(wall);
        INFO(i << ": K " << wall.stiffness << ", b " << wall.viscous << ", f " << wall.friction << ", step "
               << wall.resolution << ", m " << wall.mass);
        CHECK_FALSE(control::oscillates(wall));
    }
}

TEST_CASE("a wall far beyond the damping of an ideal device hums") {
    for (const double delay : {0.0, 1e-3}) {
        SampledWall wall;
        wall.delay = delay;
        wall.stiffness = 1.5 * control::colgate_stiffness(wall);
        CHECK(control::oscillates(wall));
        const double border = control::simulated_stiffness(wall, 1e5).stiffness;
        CHECK(border > 0.9 * control::colgate_stiffness(wall));
        CHECK(border < 1.3 * control::colgate_stiffness(wall));
    }
}

TEST_CASE("the simulated stiffness of a device holds for every press and approach, and names a hand that it fails") {
    const Random random{7};
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        SampledWall wall;
        wall.delay = model.delay;
        wall.mass = model.mass + 0.1;
        wall.viscous = model.viscous + 1.0;
        wall.friction = model.friction;
        wall.resolution = model.resolution;
        wall.max_force = model.max_force;
        const control::SimulatedLimit limit = control::simulated_stiffness(wall, 500e3);
        INFO(model.name << ": " << limit.stiffness << " N/m at " << limit.press << " N and " << limit.approach
                        << " m/s");
        wall.stiffness = limit.stiffness;
        wall.press = limit.press;
        wall.approach = limit.approach;
        CHECK(control::oscillates(wall));
        // A press of 1 N alone would permit more.
        wall.press = 1.0;
        wall.approach = 0.1;
        CHECK_FALSE(control::oscillates(wall));
        wall.stiffness = 0.8 * limit.stiffness;
        for (std::uint64_t i = 0; i < 20; ++i) {
            wall.press = 0.5 * std::pow(0.8 * model.max_force / 0.5, random.uniform(2 * i));
            wall.approach = 0.3 * random.uniform(2 * i + 1);
            INFO(wall.press << " N, " << wall.approach << " m/s");
            CHECK_FALSE(control::oscillates(wall));
        }
    }
}
