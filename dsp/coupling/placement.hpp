// SPDX-License-Identifier: Apache-2.0
// Transforms between device and scene, and between tool and hand; maps forces back to the hand.
#pragma once

#include "dsp/core/types.hpp"

namespace tactus::coupling {

/// Euler angles, fixed axes: rotates about x first, then y, then z; angles in rad.
inline Quat rotation_xyz(const Vec3& angles) {
    return glm::angleAxis(angles.z, Vec3(0.0, 0.0, 1.0)) * glm::angleAxis(angles.y, Vec3(0.0, 1.0, 0.0)) *
           glm::angleAxis(angles.x, Vec3(1.0, 0.0, 0.0));
}

/// Device frame in the scene, and tool in the handle.
struct Placement {
    Pose device;         ///< frame of the device in the scene
    double scale = 1.0;  ///< m in the scene per m of the device; rotations are not scaled
    Pose grip;  ///< tool in the frame of the handle, m in the scene

    /// The device's axes at the handle's position in the scene.
    Pose frame(const Pose& handle) const { return {device.apply(handle.position * scale), device.orientation}; }
    /// The tool in the scene, for a handle in the device frame.
    Pose tool(const Pose& handle) const {
        return Pose{device.apply(handle.position * scale), device.orientation * handle.orientation} * grip;
    }
};

/// Maps a wrench about the origin of `tool`, scene axes, to the hand: about the handle, device axes. `frame` is
/// Placement::frame at the same moment. Power is equal on both sides, so forces are multiplied by `scale`
/// and a passive scene stays passive.
inline Wrench wrench_on_hand(const Wrench& on_tool, const Vec3& tool, const Pose& frame, double scale) {
    const Quat back = glm::conjugate(frame.orientation);
    return {back * on_tool.force * scale, back * (on_tool.torque + glm::cross(tool - frame.position, on_tool.force))};
}

}  // namespace tactus::coupling
