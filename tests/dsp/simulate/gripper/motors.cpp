// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/gripper/finger.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

TEST_CASE("a walking motor makes one step per cycle, 70 mm/s at 3 kHz and no more") {
    simulate::WalkingMotor motor;
    CHECK(motor.settings.step == Approx(5.185e-6).epsilon(1e-3));
    double x = 0.0;
    for (int i = 0; i < 10000; ++i) x += 1e-3 * motor.advance(10.0 * motor.settings.step * 4.5, 0.0, 1e-3);
    CHECK(x == Approx(100 * motor.settings.step * 4.5).epsilon(1e-3));  // 10 Hz for 10 s
    CHECK_FALSE(motor.limited);
    for (int i = 0; i < 100; ++i) x = motor.advance(1.0, 0.0, 1e-3);
    CHECK(x == Approx(0.07).epsilon(1e-9));
    CHECK(motor.limited);
}

TEST_CASE("motors hold without power up to their holding force and slip beyond it") {
    simulate::WalkingMotor walking;
    CHECK(walking.advance(0.0, 4.3, 1e-3) == 0.0);
    CHECK_FALSE(walking.slips);
    CHECK(walking.advance(0.0, -5.4, 1e-3) == Approx(-1.0 / 20.0));
    CHECK(walking.slips);
    simulate::WaveMotor wave;
    CHECK(wave.advance(0.0, 2.9, 1e-3, false) == 0.0);
    CHECK(wave.advance(0.0, 4.0, 1e-3, false) == Approx(1.0 / 20.0));
    CHECK(wave.advance(0.0, 0.3, 1e-3, true) == Approx(0.2));  // low-friction mode gives way
    CHECK_FALSE(wave.slips);
}

TEST_CASE("a traveling wave slows off resonance, off 90 degrees and with amplitude, and turns with the phase's sign") {
    const simulate::WaveMotor m;
    const double right = 0.5 * std::numbers::pi;
    const double full = m.speed_of({40e3, right, 1.0});
    CHECK(full == Approx(0.6));
    CHECK(m.speed_of({40e3, -right, 1.0}) == Approx(-full));
    CHECK(m.speed_of({40e3, 0.0, 1.0}) == 0.0);
    double last = full;
    for (const double off : {200.0, 800.0, 3000.0}) {
        const double v = m.speed_of({40e3 + off, right, 1.0});
        CHECK(v < last);
        last = v;
    }
    CHECK(m.speed_of({40.8e3, right, 1.0}) == Approx(full / std::sqrt(2.0)));
    CHECK(m.speed_of({40e3, right / 3.0, 1.0}) == Approx(0.5 * full));
    CHECK(m.speed_of({40e3, right, 0.5}) == Approx(0.5 * full));
}

TEST_CASE("every way of control gives the speed that is asked for, outside of the dead zone") {
    for (const simulate::WaveControl control :
         {simulate::WaveControl::frequency, simulate::WaveControl::phase, simulate::WaveControl::amplitude}) {
        simulate::WaveMotor m;
        m.control = control;
        for (const double v : {0.05, -0.2, 0.55, -0.6}) CHECK(m.speed_of(m.drive_for(v)) == Approx(v).epsilon(1e-9));
        CHECK(m.speed_of(m.drive_for(0.02)) == Approx(0.03).epsilon(1e-9));
        CHECK(m.speed_of(m.drive_for(-0.014)) == 0.0);
        CHECK(m.speed_of(m.drive_for(2.0)) == Approx(0.6).epsilon(1e-9));
    }
}

TEST_CASE("the rig is 0.38 N/mm at the finger while both springs are taut, half of it when one is slack") {
    const simulate::RigSprings rig;
    CHECK(rig.force(0.01, 0.0) == Approx(3.8));
    CHECK(rig.force(0.025, 0.0) == Approx(9.5));
    CHECK(rig.force(0.045, 0.0) - rig.force(0.040, 0.0) == Approx(0.19e3 * 5e-3));
    CHECK(rig.force(0.01, 0.01) == Approx(0.0).margin(1e-12));
}

TEST_CASE("a cord told where to be 150 times a second runs as smoothly as the servo") {
    simulate::Finger finger;
    simulate::WalkingMotor motor;
    motor.settings.holding_force = 1e9;
    finger.motor = motor;
    simulate::CordSwing swing;
    double worst = 0.0;
    for (int n = 0; n < 600; ++n) {
        const double before = swing.at(0.025);
        finger.advance(0.0, swing.advance(0.025, 1.0, 1.0 / 150.0), 1.0 / 150.0, false);
        worst = std::max(worst, std::abs(finger.force - 380.0 * swing.at(0.025)));
        CHECK(std::abs(before) <= 0.025);
    }
    CHECK(worst < 1e-9);
    CHECK(finger.position == 0.0);
}

TEST_CASE("a command acts whole periods later") {
    for (const int delay : {0, 1, 3}) {
        simulate::Finger finger;
        finger.motor = simulate::WalkingMotor{};
        finger.on_rig = false;
        finger.hand_stiffness = 0.0;
        finger.delay = delay;
        int moved_at = -1;
        for (int n = 0; n < 8 && moved_at < 0; ++n) {
            finger.advance(0.05, 0.0, 1.0 / 150.0, false);
            if (finger.position > 0.0) moved_at = n;
        }
        CHECK(moved_at == delay);
    }
}

TEST_CASE("a strain gauge is calibrated by regression, and one that is not linear shows") {
    std::vector<double> counts, newton;
    for (int f = -8; f <= 8; ++f)
        for (int again = 0; again < 3; ++again) {
            newton.push_back(0.5 * f);
            counts.push_back(120.0 + 0.5 * f * 410.0 + (again - 1));
        }
    const simulate::LineFit fit = simulate::fit_line(counts, newton);
    CHECK(fit.slope == Approx(1.0 / 410.0).epsilon(1e-4));
    CHECK(fit(120.0) == Approx(0.0).margin(1e-6));
    CHECK(fit.r_squared > 0.9999);
    for (double& f : newton) f += 0.05 * f * std::abs(f);
    CHECK(simulate::fit_line(counts, newton).worst_residual > 10.0 * fit.worst_residual);
    CHECK(simulate::fit_line({}, {}).slope == 0.0);
    CHECK(simulate::fit_line(std::vector<double>{1, 1}, std::vector<double>{0, 5}).slope == 0.0);
}

TEST_CASE("counting is to the nearest step, and noise depends on the index only") {
    CHECK(simulate::Quantiser{0.5, 0.0, {}}(1.3, 0) == 1.5);
    CHECK(simulate::Quantiser{}(1.3, 0) == 1.3);
    const simulate::Quantiser noisy{0.0, 0.1, Random{5}};
    CHECK(noisy(1.0, 7) == noisy(1.0, 7));
    CHECK(noisy(1.0, 7) != noisy(1.0, 8));
}
