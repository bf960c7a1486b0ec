// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

namespace tactus::nodes {

struct DeviceInput {
    static constexpr auto about = "Reads a haptic device: pose, velocity and buttons, in the device frame.";
    static constexpr NodeRole role = NodeRole::hand_source;

    Out<Pose> pose{"pose of the handle in the device frame; keeps the last valid one while samples are invalid", "m"};
    Out<Twist> twist{"velocity of the handle, zero while samples are invalid", "m/s, rad/s"};
    Out<bool> trigger{"the trigger is held; false while samples are invalid"};
    Out<bool> second{"the second button is held"};
    Out<bool> third{"the third button is held"};
    Out<bool> fourth{"the fourth button is held"};
    Out<bool> valid{"the sample of this tick is valid"};
    Text device{"", "name of an entry of [devices]; empty: the only one"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::handle, .pose = "pose"}}; }

    void prepare(const Setup& setup) {
        port_ = &setup.host->device(device.value, DeviceUse::read, device.where);
        read();
    }
    void process(const Tick&) noexcept { read(); }

private:
    void read() noexcept {
        const DeviceSample& s = port_->sample;
        const bool good = is_good(s);
        if (good) last_ = {s.pose.position, glm::normalize(s.pose.orientation)};
        pose = last_;
        twist = good ? s.twist : Twist{};
        trigger = good && (s.buttons & button_trigger) != 0;
        second = good && (s.buttons & button_second) != 0;
        third = good && (s.buttons & button_third) != 0;
        fourth = good && (s.buttons & button_fourth) != 0;
        valid = good;
    }

    // Bits of DeviceSample::buttons; bit 1 marks a gap of a replayed recording.
    static constexpr std::uint32_t button_second = 4u, button_third = 8u, button_fourth = 16u;
    DevicePort* port_ = nullptr;
    Pose last_;
};

TACTUS_NODE(DeviceInput, pose, twist, trigger, second, third, fourth, valid, device)
TACTUS_VISUALS(DeviceInput)

}  // namespace tactus::nodes
