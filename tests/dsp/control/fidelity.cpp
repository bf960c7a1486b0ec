// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/fidelity.hpp"

#include "dsp/core/error.hpp"
#include "tests/dsp/control/closed_loop.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;
using tactus::test::LoopRun;

namespace {

constexpr double tau = 2.0 * std::numbers::pi;

/// A device that renders `made` while `series` of its force is given.
control::RigSeries rendered(double stiffness, double damping, double rate, double seconds) {
    const std::complex<double> y = control::ideal_admittance({.stiffness = stiffness, .damping = damping}, rate);
    control::RigSeries s;
    for (int n = 0; n < static_cast<int>(seconds * 150); ++n) {
        const std::complex<double> turn = std::polar(3.0, tau * rate * n / 150.0);
        s.force.push_back(turn.imag());
        s.position.push_back((y * turn).imag());
    }
    return s;
}

/// WQSM with assumed parameters of the middle of their range, at half of the gain limit.
LoopRun walking(double stiffness, double amplitude, double rate) {
    LoopRun run;
    run.object = {.stiffness = stiffness};
    run.finger.motor = simulate::WalkingMotor{};
    run.finger.encoder.step = 4.5e-3 / 16000.0;
    run.finger.gauge = {0.005, 0.01, Random{3}};
    run.loop.gain = 0.5 * control::gain_limit(control::LoopModel{.hand_stiffness = 380.0}, run.object);
    run.amplitude = amplitude;
    run.rate = rate;
    run.seconds = 2.0 + 4.0 / rate;
    return run;
}

}  // namespace

TEST_CASE("an ideal device is judged faultless, and what it renders is read off") {
    for (const double rate : {0.1, 0.5, 1.5})
        for (const double damping : {0.0, 50.0}) {
            const control::Fidelity f = control::judge_fidelity(rendered(1000.0, damping, rate, 2.0 + 4.0 / rate),
                                                                {.stiffness = 1000.0, .damping = damping}, rate, 1.0);
            CAPTURE(rate, damping);
            CHECK(*f.gain_error_db == Approx(0.0).margin(1e-9));
            CHECK(*f.phase_error_deg == Approx(0.0).margin(1e-9));
            CHECK(*f.nrmse < 5e-4);
            CHECK(f.rendered_stiffness == Approx(1000.0).epsilon(1e-9));
            CHECK(f.rendered_damping == Approx(damping).margin(1e-6));
            CHECK(f.limit_cycle_rms < 1e-12);
        }
}

TEST_CASE("a device that is 10 % too soft and late is told so") {
    control::RigSeries s = rendered(1000.0, 0.0, 0.5, 12.0);
    for (std::size_t n = s.position.size(); n-- > 3;) s.position[n] = 1.1 * s.position[n - 3];
    const control::Fidelity f = control::judge_fidelity(s, {.stiffness = 1000.0}, 0.5, 2.0);
    CHECK(*f.gain_error_db == Approx(20.0 * std::log10(1.1)).epsilon(1e-9));
    CHECK(*f.phase_error_deg == Approx(-360.0 * 0.5 * 3.0 / 150.0).epsilon(1e-9));
    CHECK(*f.nrmse == Approx(std::abs(std::polar(1.1, -tau * 0.5 * 0.02) - 1.0)).epsilon(1e-3));
}

TEST_CASE("samples that slip do not count, hunting is told apart from harmonics, too short a record is refused") {
    control::RigSeries s = rendered(1000.0, 0.0, 0.5, 12.0);
    s.slips.assign(s.force.size(), 0);
    for (std::size_t n = 0; n < s.force.size(); ++n)
        if (n % 300 < 40) {
            s.slips[n] = 1;
            s.position[n] += 0.02;
        }
    const control::Fidelity f = control::judge_fidelity(s, {.stiffness = 1000.0}, 0.5, 2.0);
    CHECK(*f.nrmse < 1e-3);
    CHECK(*f.gain_error_db == Approx(0.0).margin(1e-6));
    CHECK(f.slip_share == Approx(40.0 / 300.0).epsilon(0.05));
    control::RigSeries hunting = rendered(1000.0, 0.0, 0.5, 12.0);
    for (std::size_t n = 0; n < hunting.position.size(); ++n)
        hunting.position[n] += 1e-4 * std::sin(0.9 * static_cast<double>(n));
    CHECK(control::judge_fidelity(hunting, {.stiffness = 1000.0}, 0.5, 2.0).limit_cycle_rms ==
          Approx(0.707e-4).epsilon(0.02));
    CHECK_THROWS_WITH(control::judge_fidelity(s, {.stiffness = 1000.0}, 0.1, 2.0),
                      Catch::Matchers::ContainsSubstring("two whole cycles"));
    s.force[7] = NAN;
    CHECK_THROWS_WITH(control::judge_fidelity(s, {.stiffness = 1000.0}, 0.5, 2.0),
                      Catch::Matchers::ContainsSubstring("sample 8"));
}

TEST_CASE("closed forms of the rig: 157.08 mm/s, 0.446 Hz, 6.88 mm") {
    CHECK(simulate::peak_cord_speed(0.05, 1.0) * 1e3 == Approx(157.08).epsilon(1e-3));
    CHECK(simulate::saturation_rate(simulate::WalkingMotorSettings{}.max_speed(), 0.025,
                                    simulate::RigSprings{}.at_finger(), 0.0) == Approx(0.446).epsilon(1e-3));
    CHECK(simulate::WalkingMotorSettings{}.max_speed() == Approx(0.07).epsilon(1e-12));
    LoopRun run = walking(1000.0, 0.025, 0.02);
    std::get<simulate::WalkingMotor>(run.finger.motor).settings.holding_force = 100.0;
    run.finger.gauge = {};
    const control::Fidelity f = control::judge_fidelity(run(), run.object, 0.02, 2.0);
    CHECK(std::abs(f.position) * 1e3 == Approx(0.025e3 * 0.38 / 1.38).epsilon(1e-3));
    CHECK(0.025e3 * 0.38 / 1.38 == Approx(6.88).epsilon(1e-3));
}

TEST_CASE("springs come out within 2 % at 0.1 Hz without slip, from 0.1 to 10 N/mm") {
    for (const double k : {100.0, 200.0, 1000.0, 5000.0, 10000.0}) {
        LoopRun run = walking(k, 0.007, 0.1);
        const control::Fidelity f = control::judge_fidelity(run(), run.object, 0.1, 2.0);
        CAPTURE(k, f.rendered_stiffness);
        CHECK(f.slip_share == 0.0);
        CHECK(f.rendered_stiffness == Approx(k).epsilon(0.02));
    }
}

TEST_CASE("the walking motor follows free motion up to 0.446 Hz") {
    // As free as a stable loop can be: a damper so weak that the cord hardly stretches its springs.
    const auto saturates = [](double rate) {
        LoopRun run = walking(0.0, 0.025, rate);
        run.object = {.stiffness = 0.0, .damping = 8.0};
        run.finger.gauge = {};
        run.loop.gain = 0.5 * control::gain_limit(control::LoopModel{.hand_stiffness = 380.0}, run.object);
        return control::judge_fidelity(run(), run.object, rate, 3.0).saturated_share > 0.0;
    };
    double low = 0.3, high = 0.7;
    for (int i = 0; i < 12; ++i) (saturates(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    CHECK(low == Approx(0.446).epsilon(0.02));
}

TEST_CASE("feed-forward renders a spring several times better than the loop of the thesis") {
    for (const double k : {500.0, 1000.0, 5000.0}) {
        LoopRun plain = walking(k, 0.007, 0.5);
        const double without = *control::judge_fidelity(plain(), plain.object, 0.5, 2.0).nrmse;
        LoopRun led = walking(k, 0.007, 0.5);
        led.loop.feed_forward = 1.0;
        led.loop.feed_forward_lag = 0.02;
        led.loop.gain =
            0.5 *
            control::gain_limit(
                control::LoopModel{.hand_stiffness = 380.0, .feed_forward = 1.0, .feed_forward_lag = 0.02}, led.object);
        const double with = *control::judge_fidelity(led(), led.object, 0.5, 2.0).nrmse;
        CAPTURE(k, without, with);
        CHECK(without > 3.0 * with);
    }
}

TEST_CASE("a wall holds, and slips where the cord pulls harder than the motor can") {
    LoopRun gentle = walking(1000.0, 0.007, 0.1);
    gentle.object = {.kind = control::ObjectKind::wall};
    const control::Fidelity held = control::judge_fidelity(gentle(), gentle.object, 0.1, 2.0);
    CHECK(held.slip_share == 0.0);
    CHECK(held.penetration < 1e-5);
    LoopRun hard = walking(1000.0, 0.025, 0.05);
    hard.object = {.kind = control::ObjectKind::wall};
    const control::Fidelity slipped = control::judge_fidelity(hard(), hard.object, 0.05, 2.0);
    CHECK(slipped.slip_share > 0.2);
    CHECK(slipped.penetration > 1e-4);
    CHECK(slipped.penetration < 0.025);
}
