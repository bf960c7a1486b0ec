// SPDX-License-Identifier: Apache-2.0
// What of a patch can be seen in space, told by the types of its ports and the names of its parameters: any node that has
// them is drawn, also one that did not exist when this was written.
#pragma once

#include "dsp/contact/blade.hpp"
#include "dsp/core/types.hpp"
#include "graph/compile/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::picture {

/// Names are those of outputs, "node.port"; empty: there is none.
struct SceneOutline {
    /// An output that is a bone.
    struct Bone {
        std::string port;
    };
    /// A bone that stays as it is: a file that nodes are given, and none of them carves or moves.
    struct StillBone {
        std::string name, path;
    };
    /// An output that is a scene; `bodies` are the outputs that give its places.
    struct Bodies {
        std::string port;
        std::vector<std::string> bodies;
    };
    /// A body of a scene in the hand: a node with a scene and a parameter `held`.
    struct Held {
        std::string scene;
        std::string pose;  ///< where the body is: the proxy
        std::string hand;  ///< where the hand is
        std::string grip;  ///< of the body in the hand, or:
        Pose grip_at;
        std::string place;  ///< which body, or:
        double held = 0.0;
        std::string wrench;
    };
    /// A saw blade: a node with a pose, a bone, and the size of a blade.
    struct Blade {
        std::string node, pose, wrench;
        contact::BladeShape shape;
    };
    /// A ball that stands for the hand: on top, where it really is, and where it would be within.
    struct Ball {
        std::string pose, hand, wrench;  ///< pose: the proxy, or the hand itself when there is none
        double radius = 0.5e-3;
    };
    struct FixedBall {
        Vec3 centre{0.0};
        double radius = 0.0;
    };
    /// Fingers of a gripper, and the hand that carries it.
    struct Fingers {
        std::string node, finger, thumb, force, hand;
    };
    struct Weight {
        std::string hand, height;
    };
    /// A handle of which nothing else is known: drawn as axes.
    struct Handle {
        std::string pose;
    };

    /// How a device stands in the scene: its handle, the same place with the device's axes in the scene, and the scale.
    struct Place {
        std::string device, frame, scale;
    };

    std::string title;
    std::vector<Bone> bones;
    std::vector<StillBone> still_bones;
    std::vector<Bodies> scenes;
    std::vector<Held> held;
    std::vector<Blade> blades;
    std::vector<Ball> balls;
    std::vector<FixedBall> fixed_balls;
    std::vector<Fingers> fingers;
    std::vector<Weight> weights;
    std::vector<Handle> handles;
    std::vector<Place> places;  ///< nothing to see by themselves

    bool empty() const;
    /// Every output that it speaks of, each once.
    std::vector<std::string> ports() const;
};

/// Of a plan that was just compiled; it need not have its assets.
SceneOutline outline_of(const compile::Plan& plan);

}  // namespace tactus::picture
