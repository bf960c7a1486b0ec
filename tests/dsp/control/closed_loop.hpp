// SPDX-License-Identifier: Apache-2.0
// A gripper on the rig as a loop of plain structs, sampled as the engine samples it.
#pragma once

#include "dsp/control/fidelity.hpp"
#include "dsp/control/loop_stability.hpp"
#include "dsp/control/position_loop.hpp"
#include "dsp/simulate/gripper/finger.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test {

struct LoopRun {
    control::ObjectSettings object;
    control::PositionLoopSettings loop;
    simulate::Finger finger;
    double amplitude = 0.025, rate = 1.0, seconds = 10.0;
    double period = 1.0 / 150.0;

    control::RigSeries operator()() {
        control::VirtualObject virtual_object;
        virtual_object.set(object, period);
        virtual_object.place(0.0);
        control::PositionLoop position_loop;
        simulate::CordSwing swing;
        control::RigSeries series;
        series.period = period;
        double before = virtual_object.position();
        const auto ticks = static_cast<std::uint64_t>(std::llround(seconds / period));
        for (std::uint64_t n = 0; n < ticks; ++n) {
            const double force = finger.gauge(finger.force, n), position = finger.encoder(finger.position, n);
            const double wanted = virtual_object.step(force);
            const double speed = position_loop(loop, wanted, position, wanted - before, period);
            before = wanted;
            series.force.push_back(force);
            series.position.push_back(position);
            series.saturated.push_back(position_loop.saturated);
            finger.advance(speed, swing.advance(amplitude, rate, period), period, false);
            series.slips.push_back(finger.slipped);
        }
        return series;
    }
};

/// A motor without any limit, only lag.
inline simulate::WaveMotor free_running(double lag) {
    simulate::WaveMotor motor;
    motor.settings.max_speed = 1e9;
    motor.settings.least_speed = motor.settings.dead_zone = 0.0;
    motor.settings.holding_force = 1e9;
    motor.settings.lag = lag;
    motor.control = simulate::WaveControl::amplitude;
    return motor;
}

enum class Fate { dies_down, grows, undecided };

/// What becomes of a knock under an object and a gain. Nothing is limited.
inline Fate fate(const control::LoopModel& model, double gain) {
    LoopRun run;
    run.object = {.kind = model.is_wall ? control::ObjectKind::wall : control::ObjectKind::elastic,
                  .stiffness = model.stiffness,
                  .damping = model.damping,
                  .mass = model.mass};
    run.loop = {gain, model.feed_forward, model.feed_forward_lag, 1e9};
    run.finger.motor = free_running(model.motor_lag);
    run.finger.rig = {0.5 * model.hand_stiffness, 1e4};
    run.finger.delay = model.delay;
    run.finger.position = 0.001;
    run.amplitude = 0.0;
    run.seconds = 8.0;
    const control::RigSeries series = run();
    double early = 0.0, late = 0.0;
    for (std::size_t n = 0; n < series.position.size(); ++n) {
        const double swing = std::abs(series.position[n]);
        if (!(swing < 1e3)) return Fate::grows;
        if (n >= 150 && n < 300) early = std::max(early, swing);
        if (n >= 1050) late = std::max(late, swing);
    }
    if (late < 0.5 * early || late < 1e-9) return Fate::dies_down;
    return late > 2.0 * early ? Fate::grows : Fate::undecided;
}

}  // namespace tactus::test
