// SPDX-License-Identifier: Apache-2.0
#include "tools/render/scene_outline.hpp"

#include "dsp/coupling/scene.hpp"
#include "graph/node/assets.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace tactus::render {

namespace {

/// Finds the asset that a member of a node names.
struct AssetNamed : MemberVisitor {
    std::string_view member;
    std::string name;
    void asset(std::string_view of, AssetParam& param) override {
        if (of == member) name = param.name;
    }
};

std::string path_of(const compile::Schedule& plan, const std::string& asset) {
    const auto found = std::ranges::find(plan.patch.assets, asset, &patch::PatchAsset::name);
    return found == plan.patch.assets.end() ? std::string() : found->path.string();
}

/// A node of the plan as written in the patch.
struct NodeView {
    const compile::Schedule& plan;
    int index;
    const compile::ScheduleNode& node;

    NodeView(const compile::Schedule& of, int at) : plan(of), index(at), node(of.nodes[static_cast<std::size_t>(at)]) {}

    /// The output of that name, or the one wired to the input or parameter of that name; empty: none.
    std::string port(const std::string& name) const {
        if (name.empty()) return {};
        for (const compile::ScheduleOutput& out : node.outputs)
            if (out.name == name) return node.name + "." + name;
        for (const compile::ScheduleWire& wire : plan.wires) {
            if (wire.to_node != index || wire.from_node < 0) continue;
            const auto param = node.params.find(name);
            const bool is_input =
                wire.to_input >= 0 && node.inputs[static_cast<std::size_t>(wire.to_input)].name == name;
            const bool is_param = wire.to_input < 0 && param != node.params.end() && param->second == wire.param;
            if (!is_input && !is_param) continue;
            const compile::ScheduleNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
            return from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
        }
        return {};
    }
    std::string unit(const std::string& name) const {
        const auto found = std::ranges::find(node.outputs, name, &compile::ScheduleOutput::name);
        return found == node.outputs.end() ? std::string() : found->port->unit;
    }
    /// Name in [assets] of an asset parameter; empty: none.
    std::string asset(const std::string& member) const {
        AssetNamed found;
        found.member = member;
        node.type->visit(node.instance.get(), found);
        return found.name;
    }
};

/// The same with outputs instead of names of the node's ports.
Visual resolved(Visual visual, const NodeView& view) {
    for (std::string* name : {&visual.value, &visual.scene, &visual.place, &visual.pose, &visual.hand, &visual.grip,
                              &visual.target, &visual.when, &visual.force, &visual.frame})
        *name = view.port(*name);
    for (std::string& slot : visual.slots) slot = view.port(slot);
    return visual;
}

void add(const Visual& declared, const NodeView& view, SceneOutline& outline) {
    const Visual v = resolved(declared, view);
    switch (v.kind) {
        case VisualKind::bone: outline.bones.push_back({v.value}); break;
        case VisualKind::scene: {
            SceneOutline::Bodies bodies{v.value, v.slots, path_of(view.plan, view.asset(v.asset))};
            while (!bodies.bodies.empty() && bodies.bodies.back().empty()) bodies.bodies.pop_back();
            outline.scenes.push_back(std::move(bodies));
            break;
        }
        case VisualKind::held:
            if (v.scene.empty() || v.pose.empty()) break;
            outline.held.push_back(
                {v.scene, v.pose, v.hand, v.grip, {v.at, {1.0, 0.0, 0.0, 0.0}}, v.place, v.held, v.force});
            break;
        case VisualKind::target:
            if (!v.scene.empty()) outline.targets.push_back({v.scene, v.pose, v.when, v.place});
            break;
        case VisualKind::led:
            if (!v.target.empty() && !v.when.empty()) outline.leads.push_back({v.pose, v.target, v.when});
            break;
        case VisualKind::blade:
            if (!v.pose.empty())
                outline.blades.push_back({view.node.name, v.pose, v.force, {v.size.x, v.size.y, v.size.z}});
            break;
        case VisualKind::ball:
            if (!v.pose.empty()) outline.balls.push_back({v.pose, v.hand, v.force, std::max(v.radius, 0.5e-3)});
            break;
        case VisualKind::still_ball: outline.fixed_balls.push_back({v.at, v.radius}); break;
        case VisualKind::fingers: outline.fingers.push_back({view.node.name, v.value, v.place, v.force, {}}); break;
        case VisualKind::weight: outline.weights.push_back({v.hand, v.value}); break;
        case VisualKind::workspace:
            if (!v.hand.empty() || !v.place.empty()) outline.places.push_back({v.hand, v.frame, v.value, v.place});
            break;
        case VisualKind::handle: break;
        case VisualKind::mark:
            if (!v.pose.empty())
                outline.readings.push_back({v.value, view.unit(declared.value), v.pose, v.radius, v.length});
            break;
        case VisualKind::task:
            if (const std::string path = path_of(view.plan, view.asset(v.asset)); !path.empty())
                outline.tasks.push_back({view.node.name, path});
            break;
        case VisualKind::asset_bone:
            if (const std::string name = view.asset(v.asset), path = path_of(view.plan, name); !path.empty()) {
                if (!v.value.empty()) outline.scans.push_back({v.value, path});
                else outline.still_bones.push_back({name, path, v.pose});
            }
            break;
        case VisualKind::rope:
            outline.ropes.push_back({view.node.name, v.value, path_of(view.plan, view.asset(v.asset))});
            break;
        case VisualKind::point:
        case VisualKind::line:
        case VisualKind::plane:
        case VisualKind::path:
        case VisualKind::box:
        case VisualKind::spring: outline.guides.push_back({view.node.name, v}); break;
    }
}

/// A frame that a node moves on, as one that puts the scene before a planned cut, is where that node puts it.
void lead_on(std::vector<SceneOutline::Place>& places) {
    for (SceneOutline::Place& place : places)
        for (const SceneOutline::Place& next : places)
            if (!place.device.empty() && !next.moved.empty() && next.frame == place.frame) place.moved = next.moved;
    std::erase_if(places, [](const SceneOutline::Place& place) { return place.device.empty(); });
    for (SceneOutline::Place& place : places)
        if (!place.moved.empty()) place.frame = place.moved;
}

/// Poses where nothing else is to be seen: those that nodes declare and others compute.
void add_handles(const compile::Schedule& plan, SceneOutline& outline) {
    for (const compile::ScheduleNode& node : plan.nodes)
        for (const compile::ScheduleOutput& out : node.outputs)
            if (out.port->type == &value::pose) outline.handles.push_back({node.name + "." + out.name});
}

const ValueType& bone_type = value::snapshot<volume::BoneSnapshot>;
const ValueType& scene_type = value::snapshot<coupling::Scene>;
const ValueType& body_type = value::snapshot<coupling::Body>;

/// Bones directly from a file: wired to a node, or an asset of a node that does not draw them otherwise.
void add_still_bones(const compile::Schedule& plan, SceneOutline& outline) {
    std::map<std::string, std::string> wired, named;  // path to name
    std::set<std::string> seen;
    for (const SceneOutline::StillBone& declared : outline.still_bones) seen.insert(declared.path);
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.from_node >= 0 || wire.to_input < 0) continue;
        const compile::ScheduleNode& to = plan.nodes[static_cast<std::size_t>(wire.to_node)];
        if (*to.inputs[static_cast<std::size_t>(wire.to_input)].port->type == bone_type)
            wired.emplace(path_of(plan, wire.asset), wire.asset);
    }
    for (const compile::ScheduleNode& node : plan.nodes) {
        const bool shows = std::ranges::any_of(node.outputs, [](const compile::ScheduleOutput& out) {
            const ValueType& type = *out.port->type;
            return type == bone_type || type == body_type || type == scene_type;
        });
        for (const AssetParam* asset : node.assets) {
            if (asset->name.empty() || asset->type_name != AssetLoader<bone::Bone>::name) continue;
            if (shows) seen.insert(path_of(plan, asset->name));
            else named.emplace(path_of(plan, asset->name), asset->name);
        }
    }
    for (const auto& [path, name] : named)
        if (!seen.contains(path)) wired.emplace(path, name);
    for (const auto& [path, name] : wired)
        if (!path.empty() &&
            std::ranges::find(outline.still_bones, path, &SceneOutline::StillBone::path) == outline.still_bones.end())
            outline.still_bones.push_back({name, path, {}});
}

}  // namespace

bool SceneOutline::empty() const {
    return ports().empty() && fixed_balls.empty() && still_bones.empty() && guides.empty() && tasks.empty();
}

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
    for (const auto& b : still_bones) all.insert(b.pose);
    for (const auto& l : leads) all.insert({l.pose, l.target, l.when});
    for (const auto& r : readings) all.insert({r.value, r.pose});
    for (const Rope& rope : ropes) all.insert(rope.shape);
    for (const auto& [node, v] : guides) all.insert({v.pose, v.hand, v.force, v.frame});
    all.erase("");
    return {all.begin(), all.end()};
}

bool SceneOutline::shows_the_same(const SceneOutline& other) const {
    const auto files = [](const SceneOutline& of) {
        std::set<std::string> all;
        for (const StillBone& bone : of.still_bones) all.insert("bone " + bone.path);
        for (const Bodies& scene : of.scenes) all.insert(scene.plan.empty() ? "no plan" : "plan");
        for (const Task& task : of.tasks) all.insert("task " + task.path);
        for (const Guide& guide : of.guides) all.insert("guide " + guide.node);
        return all;
    };
    return ports() == other.ports() && files(*this) == files(other) && fixed_balls.size() == other.fixed_balls.size();
}

SceneOutline outline_of(const compile::Schedule& plan) {
    SceneOutline outline;
    outline.title = plan.patch.title;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        const NodeView view(plan, static_cast<int>(i));
        for (const Visual& visual : visuals_of(*view.node.type, view.node.instance.get())) add(visual, view, outline);
    }
    lead_on(outline.places);
    add_still_bones(plan, outline);
    // A gripper on an arm moves with the arm.
    for (auto& fingers : outline.fingers)
        if (!outline.weights.empty()) fingers.hand = outline.weights.front().hand;
    if (outline.empty()) add_handles(plan, outline);
    return outline;
}

}  // namespace tactus::render
