// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/scene_outline.hpp"

#include "dsp/coupling/scene.hpp"
#include "graph/node/assets.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace tactus::picture {

namespace {

struct VectorList : MemberVisitor {
    std::map<std::string, Vec3> vectors;
    void vector(std::string_view name, Vector& value) override { vectors[std::string(name)] = value.value; }
};

/// A node of the plan as written in the patch.
struct NodeView {
    const compile::Plan& plan;
    int index;
    const compile::PlanNode& node;
    VectorList list;

    NodeView(const compile::Plan& of, int at) : plan(of), index(at), node(of.nodes[static_cast<std::size_t>(at)]) {
        node.type->visit(node.instance.get(), list);
    }

    bool has_input(std::string_view name, const ValueType& type) const {
        return std::ranges::any_of(
            node.inputs, [&](const compile::PlanInput& in) { return in.name == name && in.port->type == &type; });
    }
    /// The name of the output of that type, if any.
    std::string output(std::string_view name, const ValueType& type) const {
        for (const compile::PlanOutput& out : node.outputs)
            if (out.name == name && out.port->type == &type) return node.name + "." + out.name;
        return {};
    }
    /// The output wired to an input or a parameter.
    std::string source(std::string_view name) const {
        for (const compile::PlanWire& wire : plan.wires) {
            if (wire.to_node != index || wire.from_node < 0) continue;
            const auto param = node.params.find(std::string(name));
            const bool is_input =
                wire.to_input >= 0 && node.inputs[static_cast<std::size_t>(wire.to_input)].name == name;
            const bool is_param = wire.to_input < 0 && param != node.params.end() && param->second == wire.param;
            if (!is_input && !is_param) continue;
            const compile::PlanNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
            return from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
        }
        return {};
    }
    std::optional<double> param(std::string_view name) const {
        const auto found = node.params.find(std::string(name));
        return found == node.params.end() ? std::nullopt : std::optional(found->second->value);
    }
    Vec3 vector_or_zero(const std::string& name) const {
        const auto found = list.vectors.find(name);
        return found == list.vectors.end() ? Vec3(0.0) : found->second;
    }
};

const ValueType& bone_type = value::snapshot<volume::BoneSnapshot>;
const ValueType& scene_type = value::snapshot<coupling::Scene>;
const ValueType& body_type = value::snapshot<coupling::Body>;

void add_scene(const NodeView& view, const std::string& port, SceneOutline& outline) {
    SceneOutline::Bodies bodies{port, {}};
    for (const compile::PlanInput& input : view.node.inputs)
        if (input.port->type == &body_type) bodies.bodies.push_back(view.source(input.name));
    while (!bodies.bodies.empty() && bodies.bodies.back().empty()) bodies.bodies.pop_back();
    outline.scenes.push_back(std::move(bodies));
}

void add_held(const NodeView& view, SceneOutline& outline) {
    SceneOutline::Held held;
    held.scene = view.source("scene");
    held.pose = view.output("pose", value::pose);
    held.hand = view.source("device");
    if (held.pose.empty()) held.pose = view.source("pose");
    held.grip = view.source("grip");
    held.grip_at.position = view.vector_or_zero("grip_at");
    held.place = view.source("held");
    held.held = view.param("held").value_or(0.0);
    held.wrench = view.output("wrench", value::wrench);
    if (!held.scene.empty() && !held.pose.empty()) outline.held.push_back(std::move(held));
}

void look_at(const NodeView& view, SceneOutline& outline) {
    for (const compile::PlanOutput& out : view.node.outputs) {
        const std::string port = view.node.name + "." + out.name;
        if (out.port->type == &bone_type) outline.bones.push_back({port});
        if (out.port->type == &scene_type) add_scene(view, port, outline);
    }
    const std::string wrench = view.output("wrench", value::wrench), pose = view.source("pose");
    if (view.has_input("scene", scene_type) && view.param("held")) add_held(view, outline);
    if (const std::string target = view.output("target", value::pose), fits = view.output("fits", value::boolean),
        place = view.output("fragment", value::number), scene = view.source("scene");
        !target.empty() && !fits.empty() && !place.empty() && !scene.empty())
        outline.targets.push_back({scene, target, fits, place});
    if (view.has_input("bone", bone_type) && !pose.empty() && view.param("length") && view.param("height") &&
        view.param("thickness"))
        outline.blades.push_back(
            {view.node.name, pose, wrench, {*view.param("length"), *view.param("height"), *view.param("thickness")}});
    if (const std::string proxy = view.output("proxy", value::pose); !proxy.empty())
        outline.balls.push_back({proxy, view.source("device"), wrench, view.param("radius").value_or(0.5e-3)});
    if (view.param("tool_radius") && view.param("radius") && !pose.empty()) {
        outline.fixed_balls.push_back({view.vector_or_zero("centre"), *view.param("radius")});
        outline.balls.push_back({pose, {}, wrench, std::max(*view.param("tool_radius"), 0.5e-3)});
    }
    if (const std::string finger = view.output("finger_position", value::number); !finger.empty())
        outline.fingers.push_back({view.node.name,
                                   finger,
                                   view.output("thumb_position", value::number),
                                   view.output("finger_force", value::number),
                                   {}});
    if (const std::string frame = view.output("frame", value::pose), device = view.source("device"),
        scale = view.output("force_scale", value::number);
        !frame.empty() && !device.empty() && !scale.empty())
        outline.places.push_back({device, frame, scale});
    if (const std::string height = view.output("height", value::number);
        !height.empty() && view.has_input("hand", value::pose))
        outline.weights.push_back({view.source("hand"), height});
}

/// Bones directly from a file: wired to a node, or an asset of a node that does not draw them otherwise.
void add_still_bones(const compile::Plan& plan, SceneOutline& outline) {
    const auto path_of = [&](const std::string& asset) -> std::string {
        const auto found = std::ranges::find(plan.patch.assets, asset, &patch::PatchAsset::name);
        return found == plan.patch.assets.end() ? std::string() : found->path.string();
    };
    std::map<std::string, std::string> wired, named;  // path to name
    std::set<std::string> seen;
    for (const compile::PlanWire& wire : plan.wires) {
        if (wire.from_node >= 0 || wire.to_input < 0) continue;
        const compile::PlanNode& to = plan.nodes[static_cast<std::size_t>(wire.to_node)];
        if (to.inputs[static_cast<std::size_t>(wire.to_input)].port->type == &bone_type)
            wired.emplace(path_of(wire.asset), wire.asset);
    }
    for (const compile::PlanNode& node : plan.nodes) {
        const bool shows = std::ranges::any_of(node.outputs, [](const compile::PlanOutput& out) {
            const ValueType* type = out.port->type;
            return type == &bone_type || type == &body_type || type == &scene_type;
        });
        for (const AssetParam* asset : node.assets) {
            if (asset->name.empty() || asset->type_name != AssetLoader<bone::Bone>::name) continue;
            if (shows) seen.insert(path_of(asset->name));
            else named.emplace(path_of(asset->name), asset->name);
        }
    }
    for (const auto& [path, name] : named)
        if (!seen.contains(path)) wired.emplace(path, name);
    for (const auto& [path, name] : wired)
        if (!path.empty()) outline.still_bones.push_back({name, path});
}

}  // namespace

bool SceneOutline::empty() const { return ports().empty() && fixed_balls.empty() && still_bones.empty(); }

std::vector<std::string> SceneOutline::ports() const {
    std::set<std::string> all;
    for (const auto& b : bones) all.insert(b.port);
    for (const auto& s : scenes) all.insert(s.port);
    for (const auto& h : held) all.insert({h.pose, h.hand, h.grip, h.place, h.wrench});
    for (const auto& t : targets) all.insert({t.pose, t.fits, t.place});
    for (const auto& b : blades) all.insert({b.pose, b.wrench});
    for (const auto& b : balls) all.insert({b.pose, b.hand, b.wrench});
    for (const auto& f : fingers) all.insert({f.finger, f.thumb, f.force, f.hand});
    for (const auto& w : weights) all.insert({w.hand, w.height});
    for (const auto& h : handles) all.insert(h.pose);
    all.erase("");
    return {all.begin(), all.end()};
}

SceneOutline outline_of(const compile::Plan& plan) {
    SceneOutline outline;
    outline.title = plan.patch.title;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) look_at(NodeView(plan, static_cast<int>(i)), outline);
    add_still_bones(plan, outline);
    // A gripper on an arm moves with the arm.
    for (auto& fingers : outline.fingers)
        if (!outline.weights.empty()) fingers.hand = outline.weights.front().hand;
    if (outline.empty())
        for (const compile::PlanNode& node : plan.nodes)
            for (const compile::PlanOutput& out : node.outputs)
                if (out.port->type == &value::pose) outline.handles.push_back({node.name + "." + out.name});
    return outline;
}

}  // namespace tactus::picture
