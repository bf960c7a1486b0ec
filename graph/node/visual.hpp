// SPDX-License-Identifier: Apache-2.0
// Description of the objects that a node shows in space: bodies, tools, targets and guides. A node type declares it
// beside its ports:
//
//     std::vector<Visual> visuals() const {
//         return {{.kind = VisualKind::ball, .pose = "pose", .force = "wrench", .radius = 0.5 * diameter}};
//     }
//     …
//     TACTUS_NODE(Burr, pose, wrench, diameter)
//     TACTUS_VISUALS(Burr)
//
// Nothing is drawn for a node without a declaration, whatever the names of its ports.
#pragma once

#include "dsp/core/types.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus {

struct NodeType;

enum class VisualKind : std::uint8_t {
    bone,        ///< `value`
    scene,       ///< bodies: `value`; `slots`: inputs that name them
    held,        ///< the body at `place` of `scene`: at `pose`, in the hand at `hand` by `grip`, or by `at`; `force`
    target,      ///< target pose of the body at `place` of `scene`: `pose`, shown while `when`
    led,         ///< a pull on the held body, at `pose`, to `target`, while `when`
    blade,       ///< a saw blade: `pose`, `force`, `size` = length, height, thickness
    ball,  ///< a ball of `radius`: `pose`; with a `hand`, it is a proxy and the hand's ball is drawn too; `force`
    still_ball,  ///< a ball of `radius` at `at`
    fingers,  ///< of a gripper: `value` and `place` are the positions of finger and thumb, `force` is a number
    weight,  ///< lifted by `value` above a table, with a gripper at `hand`
    workspace,  ///< placement of a device in the scene: `hand` in device axes, `frame`, `value` = scale; not drawn
    handle,  ///< axes at `pose`, shown if the patch shows nothing else
    // Guides, in `frame`; the hand is at `hand`, the guide's force on it is `force`.
    point,  ///< `at`
    line,  ///< from `at` along `direction` (length 1) for `length`; 0: endless
    plane,  ///< through `at` with the normal `direction` (length 1)
    path,  ///< through `points`; `is_closed`
    box,  ///< around `at`, of `size`
    rope,  ///< the rope output `value`; `asset`: the centreline from which it was made
    spring,  ///< between `hand` and `pose`
    mark,  ///< a ring of `radius` about the y axis of `pose`, with the number `value` beside it in the legend, while it is above `length`
    task,  ///< the planned cut of the task `asset`, its depth stop and what it spares
    asset_bone,  ///< the bone `asset` at `pose`; without one in its own frame. With `value`: density in that output's cuts
};

/// One object that a node shows. Strings name ports, parameters or assets of the node ("": none); an input refers to
/// the output that is wired to it. Lengths are in m, from the node's parameters in the patch.
struct Visual {
    VisualKind kind = VisualKind::handle;
    std::string value = {}, scene = {}, place = {}, pose = {}, hand = {}, grip = {}, target = {}, when = {}, force = {},
                frame = {}, asset = {};
    std::vector<std::string> slots = {};
    Vec3 at{0.0}, direction{0.0, 0.0, 1.0}, size{0.0};
    double radius = 0.0, length = 0.0;
    double held = -1.0;  ///< for kind held: the place if `place` is not wired
    std::vector<Vec3> points = {};
    bool is_closed = false;
};

/// Returns the objects that a node shows; empty if its type declares none or its parameters are inconsistent. `node`
/// comes from `type.create`; it need not be prepared.
std::vector<Visual> visuals_of(const NodeType& type, const void* node);

/// Implementation of TACTUS_VISUALS.
class VisualsDeclaration {
public:
    using Gives = std::vector<Visual> (*)(const void* node);
    VisualsDeclaration(const NodeType& type, Gives gives);
};

}  // namespace tactus

/// Write it below the TACTUS_NODE line of a type with `std::vector<Visual> visuals() const`.
#define TACTUS_VISUALS(Type)                                     \
    static const ::tactus::VisualsDeclaration visuals_of_##Type( \
        node_type_##Type(), [](const void* node) { return static_cast<const Type*>(node)->visuals(); });
