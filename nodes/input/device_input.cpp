// SPDX-License-Identifier: Apache-2.0
#include "graph/node.hpp"

namespace tactus::nodes {

struct DeviceInput {
    static constexpr auto about =
        "Where the hand is: pose, velocity and trigger of a haptic device, in the frame of the device.";

    Out<Pose> pose{"handle in the device frame; keeps the last good one while samples are invalid", "m"};
    Out<Twist> twist{"velocity of the handle, zero while samples are invalid", "m/s, rad/s"};
    Out<bool> trigger{"the trigger is held; false while samples are invalid"};
    Out<bool> valid{"this tick's sample is good"};
    Text device{"", "name of an entry of [devices]; empty: the only one"};

    void prepare(const Setup& setup) {
        port_ = &setup.outside->device(device.value, DeviceUse::read, device.where);
        read();
    }
    void process(const Tick&) noexcept { read(); }

private:
    void read() noexcept {
        const DeviceSample& s = port_->sample;
        const bool good = s.valid && is_valid(s.pose) && is_finite(s.twist.linear) && is_finite(s.twist.angular);
        if (good) last_ = {s.pose.position, glm::normalize(s.pose.orientation)};
        pose = last_;
        twist = good ? s.twist : Twist{};
        trigger = good && (s.buttons & button_trigger) != 0;
        valid = good;
    }

    DevicePort* port_ = nullptr;
    Pose last_;
};

TACTUS_NODE(DeviceInput, pose, twist, trigger, valid, device)

}  // namespace tactus::nodes
