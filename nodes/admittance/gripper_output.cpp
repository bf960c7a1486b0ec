// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::nodes {

struct GripperOutput {
    static constexpr auto about =
        "Drives a gripper's motors, and the servo of a rig that holds it. After a fault the motors hold until "
        "'recover' changes.";
    static constexpr NodeRole role = NodeRole::motor_sink;

    In<double> finger_speed{"positive closes the finger", "m/s"};
    In<double> thumb_speed{optional, "of the thumb part; unconnected: the thumb part holds", "m/s"};
    In<double> cord{optional, "position of the rig's servo at the end of the tick: test_rig.cord", "m"};
    In<double> fault{optional, "number of a fault upstream, which holds the motors: admittance_controller.reason"};
    Out<double> given{"speed command of the finger's motor", "m/s"};
    Out<double> cycles{"drive cycles per second of a walking motor at that speed", "Hz"};
    Out<bool> holds{"the motors hold because of a fault"};
    Text device{"", "name of an entry of [devices]; empty: the only one"};
    Param recover{as_trigger, "0", "0", "1e9", "change the number to go on after a fault"};
    Param low_friction{discrete, "0", "0", "1",
                       "from 0.5 on the hand moves the finger freely, if the motor supports it"};
    Param drive_limit{"3 kHz", "1 Hz", "1 MHz", "drive cycles per second at full speed"};

    void prepare(const Setup& setup) {
        port_ = &setup.host->device(device.value, DeviceUse::drive, device.where);
        if (port_->info.fingers == 0) setup.fail("the device is not a gripper; use device_output");
        asked_ = recover;
        is_new_ = true;
    }

    void process(const Tick& tick) noexcept {
        const double second = thumb_speed.connected ? thumb_speed.get() : 0.0;
        // An edit clears no fault: the node before this one may have held the motors.
        if (std::exchange(is_new_, false) && port_->state == control::ForceState::by_hand)
            reason_ = last_ = port_->fault;
        const control::Fault found = fault_of(finger_speed, second);
        if (found != control::Fault::none && reason_ == control::Fault::none) {
            reason_ = last_ = found;
            ++faults_;
        }
        if (recover.value != asked_ && found == control::Fault::none) reason_ = control::Fault::none;
        asked_ = recover;
        const bool is_overdue = port_->overdue != control::Fault::none;
        const bool is_faulty = reason_ != control::Fault::none || is_overdue || upstream() != control::Fault::none;
        const bool still = is_faulty || port_->hold_off;
        MotorDrive& motors = port_->motors;
        motors.speed = {still ? 0.0 : finger_speed.get(), still ? 0.0 : second};
        motors.free = !still && low_friction >= 0.5;
        if (cord.connected && std::isfinite(cord.get())) motors.cord = cord;
        port_->fault = reason_ != control::Fault::none ? reason_ : is_overdue ? port_->overdue : upstream();
        port_->state = state();
        given = motors.speed[0];
        const double fastest = port_->info.max_speed;
        cycles = fastest > 0.0 ? std::min(1.0, std::abs(motors.speed[0]) / fastest) * drive_limit : 0.0;
        holds = is_faulty;
        held_s_ += still ? tick.elapsed_seconds() : 0.0;
    }

    void report(Report& report) const {
        report.set("gripper", "fault", std::string(control::describe(last_)));
        report.set("gripper", "faults", static_cast<double>(faults_));
        report.set("gripper", "held_s", held_s_);
    }

private:
    control::ForceState state() const noexcept {
        if (reason_ != control::Fault::none) return control::ForceState::by_hand;
        // What holds the motors is not this node's to clear.
        if (port_->fault != control::Fault::none) return control::ForceState::by_source;
        return port_->hold_off ? control::ForceState::held_back : control::ForceState::on;
    }
    control::Fault fault_of(double first, double second) const noexcept {
        if (!std::isfinite(first) || !std::isfinite(second)) return control::Fault::not_finite;
        const double most = port_->info.max_speed * (1.0 + 1e-6);
        return most > 0.0 && std::max(std::abs(first), std::abs(second)) > most ? control::Fault::beyond_drive_limit
                                                                                : control::Fault::none;
    }
    control::Fault upstream() const noexcept {
        return fault.connected ? control::fault_of_number(fault.get()) : control::Fault::none;
    }

    DevicePort* port_ = nullptr;
    double asked_ = 0.0, held_s_ = 0.0;
    control::Fault reason_ = control::Fault::none, last_ = control::Fault::none;
    bool is_new_ = true;
    std::int64_t faults_ = 0;
};

TACTUS_NODE(GripperOutput, finger_speed, thumb_speed, cord, fault, given, cycles, holds, device, recover, low_friction,
            drive_limit)

}  // namespace tactus::nodes
