// SPDX-License-Identifier: Apache-2.0
// Finds the parts of a patch that can be drawn, by port types and parameter names, so that new node types are drawn
// without changes here.
#pragma once

#include "dsp/contact/blade.hpp"
#include "dsp/core/types.hpp"
#include "graph/compile/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::picture {

/// Names are outputs, "node.port"; empty: none.
struct SceneOutline {
    /// A bone output.
    struct Bone {
        std::string port;
    };
    /// A constant bone: a file of nodes that neither carve nor move it.
    struct StillBone {
        std::string name, path;
    };
    /// A scene output; `bodies`: the outputs wired to its slots.
    struct Bodies {
        std::string port;
        std::vector<std::string> bodies;
    };
    /// A held body: a node with a scene and a parameter `held`.
    struct Held {
        std::string scene;
        std::string pose;  ///< pose of the body (the proxy)
        std::string hand;  ///< pose of the hand
        std::string grip;  ///< pose of the body in the hand, or:
        Pose grip_at;
        std::string place;  ///< slot of the body, or:
        double held = 0.0;
        std::string wrench;
    };
    /// Where a body of a scene would fit: a node with a scene and the outputs `target`, `fits` and `fragment`.
    struct Target {
        std::string scene, pose, fits, place;
    };
    /// A saw blade: a node with a pose, a bone, and the size of a blade.
    struct Blade {
        std::string node, pose, wrench;
        contact::BladeShape shape;
    };
    /// A sphere for the hand: the proxy on the surface and the real position inside.
    struct Ball {
        std::string pose, hand, wrench;  ///< pose: the proxy, or the hand without a proxy
        double radius = 0.5e-3;
    };
    struct FixedBall {
        Vec3 centre{0.0};
        double radius = 0.0;
    };
    /// The fingers of a gripper and the hand that carries it.
    struct Fingers {
        std::string node, finger, thumb, force, hand;
    };
    struct Weight {
        std::string hand, height;
    };
    /// A handle without a known shape, drawn as axes.
    struct Handle {
        std::string pose;
    };

    /// The workspace mapping of a device: its handle, the same pose in the scene, and the scale.
    struct Place {
        std::string device, frame, scale;
    };

    std::string title;
    std::vector<Bone> bones;
    std::vector<StillBone> still_bones;
    std::vector<Bodies> scenes;
    std::vector<Held> held;
    std::vector<Target> targets;
    std::vector<Blade> blades;
    std::vector<Ball> balls;
    std::vector<FixedBall> fixed_balls;
    std::vector<Fingers> fingers;
    std::vector<Weight> weights;
    std::vector<Handle> handles;
    std::vector<Place> places;  ///< not drawn

    bool empty() const;
    /// All outputs of the outline, each once.
    std::vector<std::string> ports() const;
};

/// The outline of a compiled plan; assets are not needed.
SceneOutline outline_of(const compile::Plan& plan);

}  // namespace tactus::picture
