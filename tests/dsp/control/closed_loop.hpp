// SPDX-License-Identifier: Apache-2.0
// A gripper on the rig as a loop of plain structs, sampled as the engine samples it.
#pragma once

#include "dsp/control/fidelity.hpp"
#include "dsp/control/loop_stability.hpp"
#include "dsp/control/position_loop.hpp"
#include "dsp/simulate/gripper/finger.hpp"

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

}  // namespace tactus::test
