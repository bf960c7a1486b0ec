// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/placement.hpp"
#include "graph/node.hpp"

namespace tactus::nodes {

struct Workspace {
    static constexpr auto about =
        "Places the device in the scene and the tool in the hand. Forces go back through device_wrench.";

    In<Pose> device{"handle in the device frame", "m"};
    Out<Pose> pose{"tool in the scene", "m"};
    Out<Pose> frame{"the device's axes, at the handle, in the scene; for device_wrench", "m"};
    Out<double> force_scale{"the scale, for device_wrench", "1"};
    Vector origin{"0 mm, 0 mm, 0 mm", "of the device frame in the scene"};
    Vector rotation{"0 deg, 0 deg, 0 deg", "of the device frame in the scene: about x first, then y, then z"};
    Param scale{structural, "1", "0.01", "100", "distance in the scene per distance of the device"};
    Vector grip{"0 mm, 0 mm, 0 mm", "origin of the tool in the frame of the handle"};
    Vector grip_rotation{"0 deg, 0 deg, 0 deg",
                         "of the tool in the frame of the handle: about x first, then y, then z"};

    void prepare(const Setup&) {
        placement_ = {{origin, rotation_xyz(rotation)}, scale, {grip, rotation_xyz(grip_rotation)}};
        place({});
    }
    void process(const Tick&) noexcept { place(device); }

private:
    void place(const Pose& handle) noexcept {
        pose = placement_.tool(handle);
        frame = placement_.frame(handle);
        force_scale = placement_.scale;
    }

    Placement placement_;
};

TACTUS_NODE(Workspace, device, pose, frame, force_scale, origin, rotation, scale, grip, grip_rotation)

}  // namespace tactus::nodes
