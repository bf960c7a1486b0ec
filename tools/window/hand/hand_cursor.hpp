// SPDX-License-Identifier: Apache-2.0
// Where a person at the window wants the hand: motions of the mouse, as seen on the screen, become a pose in the device
// frame. No user interface.
#pragma once

#include "dsp/core/types.hpp"

namespace tactus::window {

/// How the device lies in the scene.
struct HandPlace {
    Quat to_scene{1.0, 0.0, 0.0, 0.0};  ///< axes of the device in the scene
    double scale = 1.0;  ///< m in the scene per m of the device
    Vec3 handle{0.0};  ///< where the hand is, scene
};

/// A point of the device's frame in the scene, for a hand at `hand` in the device frame.
Vec3 in_scene(const Vec3& at, const Vec3& hand, const HandPlace& place);

class HandCursor {
public:
    /// Farthest from the hand that the cursor gets while the hand feels a force: more would only stretch the spring, m of
    /// the device.
    static constexpr double longest_spring_m = 0.03;

    /// Puts the cursor on the hand, as at the beginning of a run.
    void begin(const Pose& hand);
    /// Moves it in the scene, m.
    void move(const Vec3& by, const HandPlace& place);
    /// Turns it by a rotation vector in the scene, rad.
    void turn(const Vec3& by, const HandPlace& place);
    /// Keeps it within reach of the hand at `felt`, both in the device frame.
    void stay_near(const Pose& felt, double force_N);

    const Pose& wanted() const { return wanted_; }  ///< device frame

private:
    Pose wanted_;
};

}  // namespace tactus::window
