// SPDX-License-Identifier: Apache-2.0
// Gathers what the nodes of a patch show in space: their visuals, with the outputs that give them values.
#pragma once

#include "dsp/contact/blade.hpp"
#include "dsp/core/types.hpp"
#include "graph/compile/schedule.hpp"
#include "graph/node/visual.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::render {

/// Names are outputs, "node.port"; empty: none.
struct SceneOutline {
    /// A bone output.
    struct Bone {
        std::string port;
    };
    /// A constant bone: a file of nodes that neither carve nor move it.
    struct StillBone {
        std::string name, path;
        std::string pose;  ///< of its frame; empty: that of the scene
    };
    /// A scene output; `bodies`: the outputs that are wired to its slots.
    struct Bodies {
        std::string port;
        std::vector<std::string> bodies;
        std::string plan;  ///< file of the plan that names them; empty: none
    };
    /// What sections of the bodies of an output show: the bone in a file, or those of a plan's fragments.
    struct Scan {
        std::string port, path;
    };
    /// A held body.
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
    /// Where a body of a scene would go.
    struct Target {
        std::string scene, pose, fits, place;
    };
    /// A saw blade.
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

    /// A held body is pulled to a pose.
    struct Lead {
        std::string pose, target, when;
    };
    /// A number at a place, shown while it is above a limit.
    struct Reading {
        std::string value, unit, pose;
        double radius = 0.0, limit = 0.0;
    };
    /// A guide or a spring; its names are outputs.
    struct Guide {
        std::string node;
        Visual visual;
    };
    /// A rope, such as a vessel.
    struct Rope {
        std::string node, shape;
        std::string course = {};  ///< file of the vessel that it stands for; empty: none
    };
    /// A planned cut, from a task file.
    struct Task {
        std::string node, path;
    };
    /// The workspace mapping of a device: its handle, the same pose in the scene, and the scale.
    struct Place {
        std::string device, frame, scale;
        std::string moved = {};  ///< where another node has moved `frame` to; `frame` then names that
    };

    std::string title;
    std::vector<Bone> bones;
    std::vector<StillBone> still_bones;
    std::vector<Bodies> scenes;
    std::vector<Scan> scans;
    std::vector<Held> held;
    std::vector<Target> targets;
    std::vector<Blade> blades;
    std::vector<Ball> balls;
    std::vector<FixedBall> fixed_balls;
    std::vector<Fingers> fingers;
    std::vector<Weight> weights;
    std::vector<Handle> handles;
    std::vector<Lead> leads;
    std::vector<Reading> readings;
    std::vector<Guide> guides;
    std::vector<Rope> ropes;
    std::vector<Task> tasks;
    std::vector<Place> places;  ///< not drawn

    bool empty() const;
    /// All outputs of the outline, each once.
    std::vector<std::string> ports() const;
    /// Whether the same things are drawn, of whatever size, or another plan: a view that was fitted to the one suits the
    /// other if the plans are of one case.
    bool shows_the_same(const SceneOutline& other) const;
};

/// The outline of a compiled plan; assets are not needed.
SceneOutline outline_of(const compile::Schedule& plan);

}  // namespace tactus::render
