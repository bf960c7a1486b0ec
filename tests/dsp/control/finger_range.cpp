// SPDX-License-Identifier: Apache-2.0
// Fingers are between 0.2 and 3 N/mm stiff, depending on grip and person: an admittance loop with its default settings is
// stable against all of them, with any object.
#include "dsp/control/controller.hpp"
#include "tests/dsp/control/closed_loop.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using tactus::test::Fate;
using tactus::test::fate;

namespace {

constexpr double objects[] = {100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0};  // N/m
constexpr double fingers[] = {200.0, 380.0, 700.0, 1000.0, 1500.0, 2200.0, 3000.0};  // N/m

/// Of the default settings: half of the limit.
double default_gain(double object, double motor_lag) {
    control::ControllerSettings settings;
    settings.object.stiffness = object;
    settings.loop.gain = 0.0;
    settings.loop.motor_lag = motor_lag;
    control::AdmittanceControl control;
    REQUIRE(control.set(settings));
    return control.gain();
}

}  // namespace

TEST_CASE("a knock dies down with default settings, for every object in every finger") {
    for (const double motor_lag : {0.002, 0.004})
        for (const double object : objects) {
            const double gain = default_gain(object, motor_lag);
            for (const double finger : fingers) {
                const control::LoopModel model{.motor_lag = motor_lag, .hand_stiffness = finger, .stiffness = object};
                CAPTURE(motor_lag, object, finger, gain);
                CHECK(gain < control::gain_limit(model));
                CHECK(fate(model, gain) == Fate::dies_down);
            }
        }
}

TEST_CASE("a one-sided object is stable before it is touched, in every finger") {
    control::ControllerSettings settings;
    settings.object.one_sided = true;
    settings.loop.gain = 0.0;
    control::AdmittanceControl control;
    REQUIRE(control.set(settings));
    for (const double finger : fingers) {
        const control::LoopModel free{
            .hand_stiffness = finger, .stiffness = 0.0, .damping = settings.object.free_damping};
        CAPTURE(finger, control.gain());
        CHECK(fate(free, control.gain()) == Fate::dies_down);
    }
}

TEST_CASE("a loop that was made for a rig of 0.38 N/mm rings in a stiff finger") {
    control::LoopModel model{.hand_stiffness = 380.0, .stiffness = 200.0};
    const double gain = 0.5 * control::gain_limit(model);
    model.hand_stiffness = 1500.0;
    CHECK(fate(model, gain) == Fate::grows);
}
