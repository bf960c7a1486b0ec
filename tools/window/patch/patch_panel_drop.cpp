// SPDX-License-Identifier: Apache-2.0
// What is dropped on the picture of the patch: wires, nodes that come into another lane, types of the list.
#include "graph/patch/sub_patch.hpp"
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

std::string PatchPanel::end_name(const Hit& at) const {
    const std::string name = port_name(at);
    const std::size_t dot = name.rfind('.');
    if (name.find(patch::within_node) == std::string::npos) return name;
    const std::string offered = bench_.offered_as(name.substr(0, dot), name.substr(dot + 1));
    return offered.empty() ? name : offered;
}

void PatchPanel::finish_wire(const Hit& over) {
    const Wiring wiring = std::exchange(wiring_, {});
    // A click is no drag.
    constexpr float least = 9.0f;
    if (ImGui::GetIO().MouseDragMaxDistanceSqr[0] <= least) return;
    const PictureNode& held = bench_.picture().nodes[static_cast<std::size_t>(wiring.node)];
    const auto port = static_cast<std::size_t>(wiring.port);
    const Landing wire{end_name({wiring.is_backward ? Hit::What::input : Hit::What::output, wiring.node, wiring.port}),
                       {},
                       wiring.taken_off,
                       wiring.is_backward,
                       (wiring.is_backward ? held.inputs[port] : held.outputs[port]).type};
    const Hit::What wanted = wiring.is_backward ? Hit::What::output : Hit::What::input;
    if (over.what == wanted) return land(wire, end_name(over));
    if (over.what == Hit::What::node && over.index != wiring.node) {
        landing_ = wire;
        landing_.node = bench_.picture().nodes[static_cast<std::size_t>(over.index)].name;
        return ImGui::OpenPopup("drive");
    }
    const bool is_ground = (over.what == Hit::What::nothing || over.what == Hit::What::wire) && is_pointed_;
    if (!is_ground) return;
    if (!wiring.taken_off.empty()) {
        if (wiring.is_backward) bench_.disconnect(wire.end, wiring.taken_off);
        else bench_.disconnect(wiring.taken_off, wire.end);
    } else if (!wiring.is_backward && over.what == Hit::What::nothing)
        palette_.open(point(ImGui::GetIO().MousePos), mouse_, wire.end, wire.type);
}

void PatchPanel::land(const Landing& wire, const std::string& end) {
    if (wire.taken_off == end) return;
    if (wire.is_backward) {
        if (wire.taken_off.empty()) bench_.connect(end, wire.end);
        else bench_.reconnect_source(wire.taken_off, end, wire.end);
    } else if (wire.taken_off.empty()) bench_.connect(wire.end, end);
    else bench_.reconnect(wire.end, wire.taken_off, end);
}

/// The ports of a node that a wire dropped on it could lead to, and the parameters that it could drive.
void PatchPanel::landing_menu() {
    if (!ImGui::BeginPopup("drive")) return;
    const TypePorts* ports = bench_.ports_of(landing_.node);
    ImGui::TextDisabled("%s %s %s", landing_.end.c_str(), landing_.is_backward ? "from" : "to", landing_.node.c_str());
    std::string end;
    const auto item = [&](const std::string& name, const std::string& note) {
        const bool is_chosen = ImGui::MenuItem(name.c_str(), note.c_str());
        mark_spot("drive " + name);
        if (is_chosen) end = landing_.node + "." + name;
    };
    bool is_any = false;
    if (ports) {
        for (const PicturePort& port : landing_.is_backward ? ports->outputs : ports->inputs) {
            if (port.type && landing_.type && port.type != landing_.type) continue;
            item(port.name, port.type ? std::string(port.type->name) : "any");
            is_any = true;
        }
        if (!landing_.is_backward && (!landing_.type || landing_.type == &value::number))
            for (const auto& [name, unit] : ports->params) {
                item(name, unit);
                is_any = true;
            }
    }
    if (!is_any) ImGui::TextDisabled("nothing of it suits");
    ImGui::EndPopup();
    if (end.empty()) return;
    // Of a node within a sub-patch, what that offers.
    const std::size_t dot = end.rfind('.');
    const std::string offered = landing_.node.find(patch::within_node) == std::string::npos
                                    ? ""
                                    : bench_.offered_as(landing_.node, end.substr(dot + 1));
    land(landing_, offered.empty() ? end : offered);
}

/// Nodes that come into another lane may run there: a person decides.
void PatchPanel::let_chosen_go(const Dragging& done, Point world) {
    const PatchPicture& picture = bench_.picture();
    const Point by = world - done.from;
    const PictureLane* lane = lane_at(picture, world);
    const int pressed = done.name.empty() ? -1 : picture.find(done.name);
    if (!lane || pressed < 0) return move_chosen(by, done.is_alone);
    const PictureLane& old =
        picture.lanes[static_cast<std::size_t>(picture.nodes[static_cast<std::size_t>(pressed)].group)];
    const bool is_within = lane->name.find(patch::within_node) != std::string::npos;
    if (lane->name == old.name || is_within) return move_chosen(by, done.is_alone);
    Arrival arrival;
    arrival.lane = lane->name;
    arrival.old_lane = old.name;
    const Things things = moving(done.is_alone);
    for (const PictureNode& node : picture.nodes) {
        if (!things.nodes.contains(node.name)) continue;
        const Point corner = Point{node.box.left, node.box.top} + by;
        arrival.places[node.name] = arrival.there[node.name] = place_in_lane(picture, node, corner);
        if (&picture.lanes[static_cast<std::size_t>(node.group)] != &old || !bench_.has_lane(node.name)) continue;
        arrival.nodes.push_back(node.name);
        arrival.there[node.name] = place_for(picture, lane->name, corner);
    }
    for (const std::string& name : things.comments) arrival.comments.push_back(moved_comment(name, by));
    if (arrival.nodes.empty()) return move_chosen(by, done.is_alone);
    arrival_ = std::move(arrival);
    ImGui::OpenPopup("lane");
}

void PatchPanel::arrival_menu() {
    if (!arrival_) return;
    if (!ImGui::BeginPopup("lane")) {
        const Arrival arrival = *std::exchange(arrival_, std::nullopt);
        // Esc takes the drag back; a click beside leaves the nodes in their lane.
        if (!ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) bench_.place(arrival.places, arrival.comments);
        return;
    }
    const bool is_one = arrival_->nodes.size() == 1;
    const auto item = [&](const std::string& words, const char* spot) {
        const bool is_chosen = ImGui::MenuItem(words.c_str());
        mark_spot(spot);
        return is_chosen;
    };
    const bool runs = item(fmt::format("Run {} at {}", is_one ? "it" : "them", arrival_->lane), "run in the lane");
    const bool stays =
        item(fmt::format("Leave {} at {}", is_one ? "it" : "them", arrival_->old_lane), "leave in its lane");
    ImGui::EndPopup();
    if (!runs && !stays) return;
    const Arrival arrival = *std::exchange(arrival_, std::nullopt);
    if (stays) bench_.place(arrival.places, arrival.comments);
    else bench_.move_to_lane(arrival.nodes, arrival.lane, arrival.there);
}

void PatchPanel::take_dropped_type() {
    if (is_read_only || !ImGui::BeginDragDropTarget()) return;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(dragged_type)) {
        const std::string type(static_cast<const char*>(payload->Data), static_cast<std::size_t>(payload->DataSize));
        const PictureLane* there = lane_at(bench_.picture(), mouse_);
        const std::string lane = bench_.lane_for(type, there ? there->name : "");
        const std::string made = bench_.add_node(type, lane, place_for(bench_.picture(), lane, mouse_));
        if (!made.empty()) choose_only(made);
    }
    ImGui::EndDragDropTarget();
}

}  // namespace tactus::window
