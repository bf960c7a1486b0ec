// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/coupling_spring.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

namespace tactus::nodes {

struct Spring {
    static constexpr auto about =
        "A spring and a damper between the device and an object, in position and in orientation. All poses and "
        "velocities must be in the same frame.";

    In<Pose> device{"pose of the device", "m"};
    In<Pose> object{of_world, "pose of the object", "m"};
    In<Twist> device_twist{optional, "velocity of the device, for the damper", "m/s, rad/s"};
    In<Twist> object_twist{optional, "velocity of the object, for the damping", "m/s, rad/s"};
    Out<Wrench> wrench{"on the device, about its origin; the object feels the opposite", "N, N m"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "force per distance between device and object"};
    Param damping{"0 N s/m", "0 N s/m", "50 N s/m", "force per relative velocity"};
    Param angular_stiffness{"0 N m/rad", "0 N m/rad", "20 N m/rad",
                            "torque per angle between device and object; it falls from 135° to nothing at 180°"};
    Param angular_damping{"0 N m s/rad", "0 N m s/rad", "1 N m s/rad", "torque per relative angular velocity"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::spring, .pose = "object", .hand = "device", .force = "wrench"}};
    }

    void process(const Tick&) noexcept {
        const Vec3 velocity = object_twist->linear - device_twist->linear;
        const Vec3 spin = object_twist->angular - device_twist->angular;
        const Vec3 angle =
            tactus::coupling::TurnSpring::effective(rotation_between(device->orientation, object->orientation));
        wrench = {(object->position - device->position) * stiffness.value + velocity * damping.value,
                  angle * angular_stiffness.value + spin * angular_damping.value};
    }
};

TACTUS_NODE(Spring, device, object, device_twist, object_twist, wrench, stiffness, damping, angular_stiffness,
            angular_damping)
TACTUS_VISUALS(Spring)

}  // namespace tactus::nodes
