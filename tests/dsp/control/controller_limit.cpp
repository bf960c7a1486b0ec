// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/controller.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("the gain's limit is that of the settings of now, whatever came before") {
    control::ControllerSettings settings;
    settings.loop.gain = 0.0;
    settings.object.damping = 2.0;
    settings.loop.hand_stiffness = 380.0;
    control::AdmittanceControl control;
    const auto check = [&] {
        control::AdmittanceControl fresh;
        REQUIRE(fresh.set(settings));
        REQUIRE(control.set(settings));
        CHECK(control.limit() == fresh.limit());
        CHECK(control.gain() == fresh.gain());
    };
    check();
    settings.object.rest = 0.01;
    check();
    settings.gain_share = 0.3;
    check();
    settings.loop.gain = 0.5 * control.limit();
    check();
    settings.loop.gain = 0.0;
    settings.object.stiffness = 200.0;
    check();
    settings.object.one_sided = true;
    check();
    settings.object.free_damping = 40.0;
    check();
    settings.loop.delay = 2;
    check();
    settings.loop.hand_stiffness = 100.0;
    check();
}
