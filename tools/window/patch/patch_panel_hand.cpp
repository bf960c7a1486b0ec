// SPDX-License-Identifier: Apache-2.0
// Mouse interaction with the picture of the patch.
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/patch/patch_panel.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

void PatchPanel::choose_only(const std::string& name) {
    selected = name;
    chosen.clear();
    chosen_comments.clear();
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
    dragging_ = {What::nothing, world, world, {}, false};
    if (over.what == Hit::What::output || over.what == Hit::What::input) {
        if (is_read_only) return;
        wiring_ = {over.index, over.port, over.what == Hit::What::input, {}, {}, {}};
        if (over.what == Hit::What::output) return;
        // A wire that is there comes off its input.
        for (const PictureWire& wire : picture.wires)
            if (wire.to == over.index && wire.input == over.port)
                wiring_ = {wire.from, wire.output, false, end_name(over), {}, {}};
        return;
    }
    if (over.what == Hit::What::node) {
        dragging_.name = picture.nodes[static_cast<std::size_t>(over.index)].name;
        press_node(dragging_.name);
        if (!is_read_only) dragging_.what = What::chosen;
        return;
    }
    if (over.what == Hit::What::wire) {
        if (!is_read_only) press_wire(picture.wires[static_cast<std::size_t>(over.index)], world);
        return;
    }
    if (const PictureComment* comment = comment_at(world); comment && !is_read_only)
        return press_comment(*comment, world);
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.KeyShift && !io.KeyCtrl) choose_only("");
    dragging_.what = What::frame;
}

/// Near one of its ends a wire is taken off there.
void PatchPanel::press_wire(const PictureWire& wire, Point world) {
    const Hit from{Hit::What::output, wire.from, wire.output}, to{Hit::What::input, wire.to, wire.input};
    const PatchPicture& picture = bench_.picture();
    const Point
        a = picture.nodes[static_cast<std::size_t>(wire.from)].outputs[static_cast<std::size_t>(wire.output)].at,
        b = picture.nodes[static_cast<std::size_t>(wire.to)].inputs[static_cast<std::size_t>(wire.input)].at;
    const double to_a = std::hypot(world.x - a.x, world.y - a.y), to_b = std::hypot(world.x - b.x, world.y - b.y);
    const double near = (to_a + to_b) / 3.0;
    if (to_a < near) wiring_ = {wire.to, wire.input, true, end_name(from), {}, {}};
    else if (to_b < near) wiring_ = {wire.from, wire.output, false, end_name(to), {}, {}};
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
    if (done.what == What::chosen) let_chosen_go(done, world);
    else if (done.what == What::corner) {
        patch::PatchComment moved = moved_comment(done.name, {0.0, 0.0});
        if (moved.name.empty()) return;
        moved.size = {std::max(moved.size.x + by.x, 60.0), std::max(moved.size.y + by.y, 30.0)};
        bench_.comment(moved);
    } else if (done.what == What::frame) {
        const Box box{std::min(done.from.x, world.x), std::min(done.from.y, world.y), std::max(done.from.x, world.x),
                      std::max(done.from.y, world.y)};
        for (const PictureNode& node : picture.nodes)
            if (node.box.meets(box)) chosen.insert(node.name), selected = node.name;
        for (const PictureComment& comment : picture.comments)
            if (comment.box.meets(box)) chosen_comments.insert(comment.name);
    }
}

void PatchPanel::handle_mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const Point mouse = point(io.MousePos) - corner_;
    const bool inside = is_pointed_ = ImGui::IsItemHovered();
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
        menu_at_ = world;
        if (hovered_.what == Hit::What::node)
            press_node(bench_.picture().nodes[static_cast<std::size_t>(hovered_.index)].name);
        ImGui::OpenPopup("menu");
    }
}

void PatchPanel::explain(const Hit& over) {
    const PatchPicture& picture = bench_.picture();
    if (over.what == Hit::What::wire) {
        const PictureWire& wire = picture.wires[static_cast<std::size_t>(over.index)];
        const PictureNode &from = picture.nodes[static_cast<std::size_t>(wire.from)],
                          &to = picture.nodes[static_cast<std::size_t>(wire.to)];
        const PicturePort& output = from.outputs[static_cast<std::size_t>(wire.output)];
        show_tooltip(fmt::format("{}.{} -> {}.{}\n{}, {}", from.name, output.name, to.name,
                                 to.inputs[static_cast<std::size_t>(wire.input)].name,
                                 output.type ? std::string(output.type->name) : "any",
                                 wire.fault.empty() ? describe(wire) : wire.fault));
    } else if (over.what == Hit::What::input || over.what == Hit::What::output) {
        const PictureNode& node = picture.nodes[static_cast<std::size_t>(over.index)];
        const PicturePort& port =
            (over.what == Hit::What::input ? node.inputs : node.outputs)[static_cast<std::size_t>(over.port)];
        std::string text =
            fmt::format("{}.{}: {}{}{}{}{}{}", node.name, port.name, port.type ? port.type->name : "any type",
                        port.unit.empty() ? "" : ", ", port.unit, port.is_param ? ", parameter" : "",
                        port.about.empty() ? "" : "\n", port.about);
        if (wiring_.node >= 0 && (over.what == Hit::What::output) == wiring_.is_backward) {
            const std::string held =
                end_name({wiring_.is_backward ? Hit::What::input : Hit::What::output, wiring_.node, wiring_.port});
            const std::string end = end_name(over);
            if (held + ">" + end != wiring_.checked) {
                wiring_.checked = held + ">" + end;
                wiring_.objection =
                    (wiring_.is_backward ? bench_.objection(end, held) : bench_.objection(held, end)).value_or("");
            }
            if (!wiring_.objection.empty()) text = wiring_.objection;
        }
        show_tooltip(text);
    }
}

void PatchPanel::menus() {
    const PatchPicture& picture = bench_.picture();
    if (ImGui::BeginPopup("menu")) {
        if (menu_.what == Hit::What::wire) {
            const PictureWire& wire = picture.wires[static_cast<std::size_t>(menu_.index)];
            const Hit from{Hit::What::output, wire.from, wire.output}, to{Hit::What::input, wire.to, wire.input};
            const std::string a = port_name(from), b = end_name(to), written = end_name(from);
            ImGui::TextDisabled("%s -> %s", a.c_str(), b.c_str());
            if (ImGui::MenuItem("Show in a scope")) wants_scope = a;
            if (!is_read_only) {
                if (ImGui::BeginMenu("Deliver as")) {
                    for (const char* mode : {"hold", "linear", "batch", "delay 1"})
                        if (ImGui::MenuItem(mode)) bench_.connect(written, b, mode);
                    ImGui::EndMenu();
                }
                if (ImGui::MenuItem("Remove the wire")) bench_.disconnect(b, written);
            }
        } else if (menu_.what == Hit::What::output) {
            if (ImGui::MenuItem("Show in a scope")) wants_scope = port_name(menu_);
        } else if (menu_.what == Hit::What::input) {
            if (ImGui::MenuItem("Remove the wire", nullptr, false, !is_read_only)) bench_.disconnect(end_name(menu_));
        } else if (menu_.what == Hit::What::node) {
            const PictureNode& node = picture.nodes[static_cast<std::size_t>(menu_.index)];
            node_menu(node.name, node.is_part);
        } else canvas_menu();
        ImGui::EndPopup();
    }
    landing_menu();
    arrival_menu();
}

}  // namespace tactus::window
