// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <cmath>

namespace tactus::nodes {

struct GripperInput {
    static constexpr auto about =
        "Reads a gripper's sensors: position and force of the finger, and of the thumb part if it has one.";

    Out<double> finger_position{"positive closes the finger; keeps the last valid value while samples are invalid",
                                "m"};
    Out<double> finger_force{"of the hand on the finger; positive closes it; 0 while samples are invalid", "N"};
    Out<double> thumb_position{"of the thumb part, 0 without one", "m"};
    Out<double> thumb_force{"on the thumb part, 0 without one", "N"};
    Out<bool> slips{"the load moves the finger although its motor holds"};
    Out<bool> thumb_slips{"the load moves the thumb part although its motor holds"};
    Out<bool> limited{"a motor is at its speed limit"};
    Out<bool> valid{"the sample of this tick is valid"};
    Out<double> fault{"number of the fault, for admittance_controller; 0: none"};
    Out<double> max_speed{"of a finger", "m/s"};
    Out<double> least_speed{"below it a motor does not turn; 0: it turns at any speed", "m/s"};
    Text device{"", "name of an entry of [devices]; empty: the only one"};
    Param stale_after{structural, "25 ms", "0 ms", "10 s",
                      "a sensor without a new sample for this long counts as lost"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::fingers,
                 .value = "finger_position",
                 .place = "thumb_position",
                 .force = "finger_force"}};
    }

    void prepare(const Setup& setup) {
        port_ = &setup.host->device(device.value, DeviceUse::read, device.where);
        if (port_->info.fingers == 0) setup.fail("the device is not a gripper; use device_input");
        read(0.0);
    }
    void process(const Tick& tick) noexcept { read(tick.elapsed_seconds()); }

private:
    void read(double elapsed) noexcept {
        const DeviceSample& s = port_->sample;
        unchanged_for_ = s.counter == counter_ ? unchanged_for_ + elapsed : 0.0;
        counter_ = s.counter;
        const control::Fault found = fault_of(s);
        const bool good = found == control::Fault::none;
        if (good) last_ = s.fingers;
        finger_position = last_[0].position;
        finger_force = good ? last_[0].force : 0.0;
        thumb_position = last_[1].position;
        thumb_force = good ? last_[1].force : 0.0;
        slips = good && (last_[0].state & motor_slips) != 0;
        thumb_slips = good && (last_[1].state & motor_slips) != 0;
        limited = good && ((last_[0].state | last_[1].state) & motor_limited) != 0;
        valid = good;
        fault = static_cast<double>(found);
        max_speed = port_->info.max_speed;
        least_speed = port_->info.least_speed;
    }

    control::Fault fault_of(const DeviceSample& s) const noexcept {
        if (!s.valid) return control::Fault::invalid_input;
        if (unchanged_for_ > stale_after) return control::Fault::stale_input;
        for (const FingerSample& finger : s.fingers)
            if (!std::isfinite(finger.position) || !std::isfinite(finger.force)) return control::Fault::not_finite;
        return control::Fault::none;
    }

    DevicePort* port_ = nullptr;
    std::array<FingerSample, max_fingers> last_{};
    std::int64_t counter_ = -1;
    double unchanged_for_ = 0.0;
};

TACTUS_NODE(GripperInput, finger_position, finger_force, thumb_position, thumb_force, slips, thumb_slips, limited,
            valid, fault, max_speed, least_speed, device, stale_after)
TACTUS_VISUALS(GripperInput)

}  // namespace tactus::nodes
