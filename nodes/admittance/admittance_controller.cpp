// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/controller.hpp"

#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::nodes {

struct AdmittanceController {
    static constexpr auto about =
        "Admittance control: the measured force moves a virtual object, and a position loop makes the motor follow it. "
        "Refuses settings with which the loop would be unstable. A one-sided object, which switches between two loops, "
        "is simulated first.";

    In<double> force{"of the hand on the finger; positive closes the finger", "N"};
    In<double> position{"of the finger", "m"};
    In<double> fault{optional, "number of a sensor fault: gripper_input.fault; the motor holds while it is not 0"};
    In<bool> slips{
        optional,
        "the load moves the finger against the motor: gripper_input.slips. A finger at rest is then no fault"};
    Out<double> velocity{"command for the motor", "m/s"};
    Out<double> wanted{"position that the object gives the finger", "m"};
    Out<bool> saturated{"the command is limited by max_speed"};
    Out<bool> holds{"the motor holds because of a fault"};
    Out<double> reason{"number of the fault; 0: none"};
    Out<bool> refused{"the parameters were rejected (unstable, or no object); the last accepted ones stay in use"};
    Out<double> used_gain{"of the position loop", "1/s"};
    Out<double> gain_limit{"limit above which the loop is unstable", "1/s"};
    Choice object{{"elastic", "wall", "table"}, "spring, damper and mass; rigid wall; measured table"};
    Choice sides{{"both", "one"}, "one: the object begins at 'rest' and lies towards +; the finger is free before it"};
    Param stiffness{internal, "1 N/mm", "0 N/mm", "100 N/mm", "of an elastic object"};
    Param damping{"0 N s/m", "0 N s/m", "1000 N s/m", "of an elastic object"};
    Param mass{"0 kg", "0 kg", "10 kg", "of an elastic object"};
    Param rest{"0 mm", "-500 mm", "500 mm", "position at which the object exerts no force"};
    Param free_damping{
        "80 N s/m", "0 N s/m", "1000 N s/m",
        "damping in front of a one-sided object; a stiff finger needs much of it: with 20 N s/m no gain is "
        "stable in a finger of 3 N/mm"};
    Asset<control::DeflectionTable> table{optional, "measured force over deflection, for object = \"table\""};
    Param gain{"0 s^-1", "0 s^-1", "10000 s^-1", "of the position loop; 0: gain_share times the stability limit"};
    Param gain_share{"0.5", "0.01", "0.95", "share of the stability limit, used when gain is 0"};
    Param feed_forward{"0", "0", "1",
                       "share of the object's velocity that is added to the command; the thesis had none"};
    Param feed_forward_lag{"20 ms", "0 ms", "1 s", "time constant of the low-pass on that velocity"};
    Param max_speed{"70 mm/s", "0 mm/s", "10 m/s", "of the motor; connect gripper_input.max_speed"};
    Param least_speed{
        "0 mm/s", "0 mm/s", "1 m/s",
        "below it the motor does not turn, so slower motion is made in steps of one tick; 0: the motor turns at any "
        "speed; connect gripper_input.least_speed"};
    Param stall_force{
        "2 N", "0 N", "1000 N",
        "force of the hand against the motion. Above it a finger at rest may be stalled; below it a stuck encoder is "
        "suspected"};
    Param motor_lag{"4 ms", "0 ms", "100 ms", "time constant of the motor's speed, for the stability limit"};
    Param delay{discrete, "1", "0", "8", "ticks from a sample to the motion of the motor, for the stability limit"};
    Param hand_stiffness{
        internal, "3 N/mm", "0 N/mm", "100 N/mm",
        "of the stiffest finger or rig that may press, for the stability limit. Fingers are between 0.2 "
        "and 3 N/mm, depending on grip and person; the test rig is 0.38 N/mm. A lower number permits a "
        "quicker loop, which is unstable in a stiffer finger"};
    Param blend{"100 ms", "0 ms", "10 s", "time in which a new object replaces the old one"};
    Param recover{as_trigger, "0", "0", "1e9", "change the number to go on after a fault"};
    Flag allow_unstable{false, "accept an unstable gain"};

    void prepare(const Setup& setup) {
        period_ = seconds(setup.period);
        if (object.is("table") && !table) setup.fail("object = \"table\" needs the asset 'table'");
        const control::ControllerSettings wanted_settings = settings();
        if (!wanted_settings.object.is_renderable())
            setup.fail("an object without stiffness, damping and mass has no force law; give a damping");
        if (!control_.set(wanted_settings)) {
            const double limit = tactus::control::switched_gain_limit(loop_of(wanted_settings), wanted_settings.object);
            const double hand = hand_stiffness * 1e-3;
            if (!(limit > 0.0))
                setup.fail(
                    fmt::format("no gain is stable with this object in a hand of {:.3g} N/mm; raise its damping or "
                                "free_damping, give the hand_stiffness of what presses, or set allow_unstable and "
                                "a gain",
                                hand));
            setup.fail(
                fmt::format("with gain {:.4g} s^-1 this object is unstable in a hand of {:.3g} N/mm: the limit is "
                            "{:.4g} s^-1; lower the gain, leave it 0, give the hand_stiffness of what presses, or set "
                            "allow_unstable",
                            gain.value, hand, limit));
        }
        name_ = setup.name;
        seen_ = wanted_settings;
        asked_ = recover;
        publish(0.0);
    }

    void process(const Tick& tick) noexcept {
        if (const control::ControllerSettings now = settings(); now != seen_) {
            seen_ = now;
            refused_ = !control_.set(now);
            refusals_ += refused_;
        }
        if (recover.value != asked_) control_.recover();
        asked_ = recover;
        const control::Fault before = control_.fault();
        const int periods = static_cast<int>(std::lround(std::min(tick.elapsed_seconds() / period_, 1e6)));
        const double speed = control_.tick(force, position, sensed(), periods, slips.connected && slips.get());
        if (control_.fault() != control::Fault::none && before == control::Fault::none) {
            last_ = control_.fault();
            ++faults_;
        }
        held_s_ += control_.fault() != control::Fault::none ? tick.elapsed_seconds() : 0.0;
        saturated_s_ += control_.saturated() ? tick.elapsed_seconds() : 0.0;
        publish(speed);
    }

    void report(Report& report) const {
        report.set(name_, "gain_per_s", control_.gain());
        report.set(name_, "gain_limit_per_s", control_.limit());
        report.set(name_, "fault", std::string(control::describe(last_)));
        report.set(name_, "faults", static_cast<double>(faults_));
        report.set(name_, "held_s", held_s_);
        report.set(name_, "saturated_s", saturated_s_);
        report.set(name_, "refused_settings", static_cast<double>(refusals_));
    }

private:
    control::ControllerSettings settings() const noexcept {
        control::ControllerSettings s;
        s.object.kind = object.is("wall")    ? control::ObjectKind::wall
                        : object.is("table") ? control::ObjectKind::table
                                             : control::ObjectKind::elastic;
        s.object.stiffness = stiffness;
        s.object.damping = damping;
        s.object.mass = mass < 1e-6 ? 0.0 : mass.value;  // less than a milligram only costs digits
        s.object.one_sided = sides.is("one");
        s.object.rest = rest;
        s.object.free_damping = free_damping;
        s.object.table = table ? &*table : nullptr;
        s.loop.period = period_;
        s.loop.gain = gain;
        s.loop.delay = static_cast<int>(std::lround(delay.value));
        s.loop.motor_lag = motor_lag;
        s.loop.hand_stiffness = hand_stiffness;
        s.loop.feed_forward = feed_forward;
        s.loop.feed_forward_lag = feed_forward_lag;
        s.gain_share = gain_share;
        s.max_speed = max_speed;
        s.least_speed = least_speed;
        s.stall_force = stall_force;
        s.blend = blend;
        s.allow_unstable = allow_unstable;
        return s;
    }

    control::Fault sensed() const noexcept {
        return fault.connected ? control::fault_of_number(fault.get()) : control::Fault::none;
    }

    void publish(double speed) noexcept {
        velocity = speed;
        wanted = control_.wanted();
        saturated = control_.saturated();
        holds = control_.fault() != control::Fault::none;
        reason = static_cast<double>(control_.fault());
        refused = refused_;
        used_gain = control_.gain();
        gain_limit = control_.limit();
    }

    control::AdmittanceControl control_;
    std::string name_;
    control::ControllerSettings seen_;
    double period_ = 1.0 / 150.0, asked_ = 0.0, held_s_ = 0.0, saturated_s_ = 0.0;
    control::Fault last_ = control::Fault::none;
    std::int64_t faults_ = 0, refusals_ = 0;
    bool refused_ = false;
};

TACTUS_NODE(AdmittanceController, force, position, fault, slips, velocity, wanted, saturated, holds, reason, refused,
            used_gain, gain_limit, object, sides, stiffness, damping, mass, rest, free_damping, table, gain, gain_share,
            feed_forward, feed_forward_lag, max_speed, least_speed, stall_force, motor_lag, delay, hand_stiffness,
            blend, recover, allow_unstable)

}  // namespace tactus::nodes
