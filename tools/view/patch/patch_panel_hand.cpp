// SPDX-License-Identifier: Apache-2.0
// Mouse interaction with the picture of the patch.
#include "tools/view/patch/patch_panel.hpp"

#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::view {

const PictureComment* PatchPanel::comment_at(Point world) const {
    const auto& all = bench_.picture().comments;
    const auto found = std::ranges::find_if(all, [&](const PictureComment& c) { return c.box.contains(world); });
    return found == all.end() ? nullptr : &*found;
}

void PatchPanel::choose_only(const std::string& name) {
    selected = name;
    chosen.clear();
    if (!name.empty()) chosen.insert(name);
}

std::optional<Point> PatchPanel::mouse_over() const {
    const Point pixel = canvas_.to_pixel(mouse_);
    if (width_ < 8.0 || !Box{0.0, 0.0, width_, height_}.contains(pixel)) return std::nullopt;
    return mouse_;
}

std::string PatchPanel::node_under_mouse() const {
    if (!mouse_over()) return {};
    const Hit under = hit(bench_.picture(), mouse_, 0.0);
    const bool is_node =
        under.what == Hit::What::node || under.what == Hit::What::input || under.what == Hit::What::output;
    if (!is_node) return {};
    const std::string& name = bench_.picture().nodes[static_cast<std::size_t>(under.index)].name;
    return name.find(':') == std::string::npos ? name : "";
}

void PatchPanel::press_node(const std::string& name) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyShift || io.KeyCtrl) {
        if (chosen.erase(name) == 0) chosen.insert(name), selected = name;
        else if (selected == name) selected = chosen.empty() ? "" : *chosen.begin();
        return;
    }
    if (!chosen.contains(name)) choose_only(name);
    selected = name;
}

void PatchPanel::press(const Hit& over, Point world) {
    const PatchPicture& picture = bench_.picture();
    using What = Dragging::What;
    dragging_ = {What::nothing, world, world, {}};
    if (over.what == Hit::What::output || over.what == Hit::What::input) {
        if (is_read_only) return;
        wiring_ = {over.index, over.port, over.what == Hit::What::input, {}, {}, {}};
        if (over.what == Hit::What::output) return;
        // A wire that is there comes off its input.
        for (const PictureWire& wire : picture.wires)
            if (wire.to == over.index && wire.input == over.port)
                wiring_ = {wire.from, wire.output, false, port_name(over), {}, {}};
        return;
    }
    if (over.what == Hit::What::node) {
        press_node(picture.nodes[static_cast<std::size_t>(over.index)].name);
        if (!is_read_only) dragging_.what = What::nodes;
        return;
    }
    if (over.what == Hit::What::wire) return;
    if (const PictureComment* comment = comment_at(world); comment && !is_read_only) {
        constexpr double corner = 16.0;
        const bool at_corner = world.x > comment->box.right - corner && world.y > comment->box.bottom - corner;
        dragging_.what = at_corner ? What::corner : What::comment;
        dragging_.name = comment->name;
        return;
    }
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.KeyShift && !io.KeyCtrl) choose_only("");
    dragging_.what = What::frame;
}

void PatchPanel::drag(Point world) {
    const float far = ImGui::GetIO().MouseDragMaxDistanceSqr[0];
    if (dragging_.what != Dragging::What::nothing && far > 9.0f) dragging_.to = world;
}

void PatchPanel::let_go(Point world) {
    const Dragging done = std::exchange(dragging_, {});
    if (!done.is_moved()) return;
    const Point by = world - done.from;
    const PatchPicture& picture = bench_.picture();
    using What = Dragging::What;
    if (done.what == What::nodes) {
        std::map<std::string, patch::PatchPlace> places;
        for (const PictureNode& node : picture.nodes)
            if (chosen.contains(node.name))
                places[node.name] = place_in_lane(picture, node, Point{node.box.left, node.box.top} + by);
        bench_.place(places);
    } else if (done.what == What::comment || done.what == What::corner) {
        const auto& all = bench_.window().comments;
        const auto found = std::ranges::find(all, done.name, &patch::PatchComment::name);
        if (found == all.end()) return;
        patch::PatchComment moved = *found;
        patch::PatchPlace& changed = done.what == What::comment ? moved.place : moved.size;
        changed = {changed.x + by.x, changed.y + by.y};
        moved.size = {std::max(moved.size.x, 60.0), std::max(moved.size.y, 30.0)};
        bench_.comment(moved);
    } else if (done.what == What::frame) {
        const Box box{std::min(done.from.x, world.x), std::min(done.from.y, world.y), std::max(done.from.x, world.x),
                      std::max(done.from.y, world.y)};
        for (const PictureNode& node : picture.nodes)
            if (node.box.meets(box)) chosen.insert(node.name), selected = node.name;
    }
}

void PatchPanel::handle_mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const Point mouse = point(io.MousePos) - corner_;
    const bool inside = ImGui::IsItemHovered();
    if (inside && io.MouseWheel != 0.0f) {
        canvas_.zoom_at(mouse, std::pow(1.15, static_cast<double>(io.MouseWheel)));
        follows_size_ = false;
    }
    if (press_minimap()) {
        hovered_ = {};
        return;
    }
    const Point world = mouse_ = canvas_.to_world(mouse);
    if (inside || wiring_.node >= 0) hovered_ = hit(bench_.picture(), world, 7.0 / std::max(canvas_.zoom, 0.3));
    else hovered_ = {};
    if (inside && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) press(hovered_, world);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag(world);
    if (inside && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        wiring_ = {};
        dragging_ = {};
        if (hovered_.what == Hit::What::output) wants_scope = port_name(hovered_);
        if (hovered_.what == Hit::What::node) {
            const PictureNode& node = bench_.picture().nodes[static_cast<std::size_t>(hovered_.index)];
            if (node.is_part && !is_read_only) bench_.open_sub_patch(node.name, true);
        }
        if (hovered_.what == Hit::What::nothing && !is_read_only) {
            if (const PictureComment* comment = comment_at(world)) commented_ = comment->name;
            else palette_.open(mouse + corner_, world, {}, nullptr);
        }
    }
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Left)) {
        if (wiring_.node >= 0) finish_wire(hovered_);
        else let_go(world);
    }
    const bool pans = ImGui::IsItemActive() && (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 3.0f) ||
                                                ImGui::IsMouseDragging(ImGuiMouseButton_Right, 3.0f));
    if (pans) {
        canvas_.pan(point(io.MouseDelta));
        follows_size_ = false;
    }
    if (inside && ImGui::IsMouseReleased(ImGuiMouseButton_Right) && io.MouseDragMaxDistanceSqr[1] < 16.0f) {
        menu_ = hovered_;
        if (hovered_.what == Hit::What::node)
            press_node(bench_.picture().nodes[static_cast<std::size_t>(hovered_.index)].name);
        ImGui::OpenPopup("menu");
    }
}

void PatchPanel::finish_wire(const Hit& over) {
    const Wiring wiring = std::exchange(wiring_, {});
    const Hit from{wiring.is_backward ? Hit::What::input : Hit::What::output, wiring.node, wiring.port};
    const std::string name = port_name(from);
    if (wiring.is_backward) {
        if (over.what == Hit::What::output) bench_.connect(port_name(over), name);
        return;
    }
    if (over.what == Hit::What::input) {
        if (wiring.taken_off.empty()) bench_.connect(name, port_name(over));
        else if (wiring.taken_off != port_name(over)) bench_.reconnect(name, wiring.taken_off, port_name(over));
        return;
    }
    if (!wiring.taken_off.empty()) {
        bench_.disconnect(wiring.taken_off, name);
        return;
    }
    if (over.what == Hit::What::node && over.index != wiring.node) {
        // A wire dropped on a node drives one of its parameters.
        menu_ = over;
        new_name_ = name;
        ImGui::OpenPopup("drive");
    } else if (over.what == Hit::What::nothing && ImGui::IsItemHovered()) {
        const PictureNode& node = bench_.picture().nodes[static_cast<std::size_t>(wiring.node)];
        palette_.open(point(ImGui::GetIO().MousePos), mouse_, name,
                      node.outputs[static_cast<std::size_t>(wiring.port)].type);
    }
}

void PatchPanel::explain(const Hit& over) {
    const PatchPicture& picture = bench_.picture();
    if (over.what == Hit::What::wire) {
        const PictureWire& wire = picture.wires[static_cast<std::size_t>(over.index)];
        const PictureNode &from = picture.nodes[static_cast<std::size_t>(wire.from)],
                          &to = picture.nodes[static_cast<std::size_t>(wire.to)];
        const PicturePort& output = from.outputs[static_cast<std::size_t>(wire.output)];
        ImGui::SetTooltip("%s.%s -> %s.%s\n%s, %s", from.name.c_str(), output.name.c_str(), to.name.c_str(),
                          to.inputs[static_cast<std::size_t>(wire.input)].name.c_str(),
                          output.type ? std::string(output.type->name).c_str() : "any", describe(wire).c_str());
    } else if (over.what == Hit::What::input || over.what == Hit::What::output) {
        const PictureNode& node = picture.nodes[static_cast<std::size_t>(over.index)];
        const PicturePort& port =
            (over.what == Hit::What::input ? node.inputs : node.outputs)[static_cast<std::size_t>(over.port)];
        std::string text =
            fmt::format("{}.{}: {}{}{}{}{}{}", node.name, port.name, port.type ? port.type->name : "any type",
                        port.unit.empty() ? "" : ", ", port.unit, port.is_param ? ", parameter" : "",
                        port.about.empty() ? "" : "\n", port.about);
        if (wiring_.node >= 0 && !wiring_.is_backward && over.what == Hit::What::input) {
            const std::string pair = port_name({Hit::What::output, wiring_.node, wiring_.port}) + ">" + port_name(over);
            if (pair != wiring_.checked) {
                wiring_.checked = pair;
                wiring_.objection =
                    bench_.objection(port_name({Hit::What::output, wiring_.node, wiring_.port}), port_name(over))
                        .value_or("");
            }
            if (!wiring_.objection.empty()) text = wiring_.objection;
        }
        ImGui::SetTooltip("%s", text.c_str());
    }
}

void PatchPanel::menus() {
    const PatchPicture& picture = bench_.picture();
    if (ImGui::BeginPopup("menu")) {
        if (menu_.what == Hit::What::wire) {
            const PictureWire& wire = picture.wires[static_cast<std::size_t>(menu_.index)];
            const Hit from{Hit::What::output, wire.from, wire.output}, to{Hit::What::input, wire.to, wire.input};
            const std::string a = port_name(from), b = port_name(to);
            ImGui::TextDisabled("%s -> %s", a.c_str(), b.c_str());
            if (ImGui::MenuItem("Show in a scope")) wants_scope = a;
            if (!is_read_only) {
                if (ImGui::BeginMenu("Deliver as")) {
                    for (const char* mode : {"hold", "linear", "batch", "delay 1"})
                        if (ImGui::MenuItem(mode)) bench_.connect(a, b, mode);
                    ImGui::EndMenu();
                }
                if (ImGui::MenuItem("Remove the wire")) bench_.disconnect(b, a);
            }
        } else if (menu_.what == Hit::What::output) {
            if (ImGui::MenuItem("Show in a scope")) wants_scope = port_name(menu_);
        } else if (menu_.what == Hit::What::input) {
            if (ImGui::MenuItem("Remove the wire", nullptr, false, !is_read_only)) bench_.disconnect(port_name(menu_));
        } else if (menu_.what == Hit::What::node) {
            const PictureNode& node = picture.nodes[static_cast<std::size_t>(menu_.index)];
            node_menu(node.name, node.is_part);
        } else canvas_menu();
        ImGui::EndPopup();
    }
    if (ImGui::BeginPopup("drive")) {
        const std::string node =
            picture.nodes.empty() || menu_.index < 0 ? "" : picture.nodes[static_cast<std::size_t>(menu_.index)].name;
        ImGui::TextDisabled("%s drives a parameter of %s", new_name_.c_str(), node.c_str());
        const TypePorts* ports =
            menu_.index < 0 ? nullptr : ports_of_type(picture.nodes[static_cast<std::size_t>(menu_.index)].type);
        if (ports)
            for (const auto& [name, unit] : ports->params) {
                const bool is_chosen = ImGui::MenuItem(name.c_str(), unit.c_str());
                mark_spot("drive " + name);
                if (!is_chosen) continue;
                bench_.connect(new_name_, node + "." + name);
                break;
            }
        ImGui::EndPopup();
    }
}

}  // namespace tactus::view
