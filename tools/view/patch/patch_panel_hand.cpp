// SPDX-License-Identifier: Apache-2.0
// Mouse interaction with the picture of the patch.
#include "tools/view/patch/patch_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::view {

void PatchPanel::handle_mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const Point mouse = point(io.MousePos) - corner_;
    const bool inside = ImGui::IsItemHovered();
    if (inside && io.MouseWheel != 0.0f) {
        canvas_.zoom_at(mouse, std::pow(1.15, static_cast<double>(io.MouseWheel)));
        follows_size_ = false;
    }
    if (inside || wiring_.node >= 0)
        hovered_ = hit(bench_.picture(), canvas_.to_world(mouse), 7.0 / std::max(canvas_.zoom, 0.3));
    else hovered_ = {};
    if (inside && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (hovered_.what == Hit::What::output && !is_read_only) wiring_ = {hovered_.index, hovered_.port, {}, {}};
        else if (hovered_.what == Hit::What::node)
            selected = bench_.picture().nodes[static_cast<std::size_t>(hovered_.index)].name;
        else if (hovered_.what == Hit::What::nothing) selected.clear();
    }
    if (inside && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        if (hovered_.what == Hit::What::output) wants_scope = port_name(hovered_);
        if (hovered_.what == Hit::What::nothing) fit();
        wiring_ = {};
    }
    if (wiring_.node >= 0 && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) finish_wire(hovered_);
    const bool drags_ground =
        ImGui::IsItemActive() && wiring_.node < 0 &&
        (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3.0f) || ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 3.0f) ||
         ImGui::IsMouseDragging(ImGuiMouseButton_Right, 3.0f));
    if (drags_ground) {
        canvas_.pan(point(io.MouseDelta));
        follows_size_ = false;
    }
    if (inside && ImGui::IsMouseReleased(ImGuiMouseButton_Right) && io.MouseDragMaxDistanceSqr[1] < 16.0f &&
        hovered_.what != Hit::What::nothing) {
        menu_ = hovered_;
        ImGui::OpenPopup("menu");
    }
    if (ImGui::IsWindowFocused() && !is_read_only && !selected.empty() &&
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete)))
        bench_.remove(selected);
}

void PatchPanel::finish_wire(const Hit& over) {
    const Hit from{Hit::What::output, wiring_.node, wiring_.port};
    if (over.what == Hit::What::input) bench_.connect(port_name(from), port_name(over));
    else if (over.what == Hit::What::node) {
        // A wire dropped on a node drives one of its parameters.
        menu_ = over;
        new_name_ = port_name(from);
        ImGui::OpenPopup("drive");
    }
    wiring_ = {};
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
        if (wiring_.node >= 0 && over.what == Hit::What::input) {
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
            const std::string name = picture.nodes[static_cast<std::size_t>(menu_.index)].name;
            ImGui::TextDisabled("%s", name.c_str());
            if (ImGui::MenuItem("Remove the node", "Del", false, !is_read_only)) bench_.remove(name);
        }
        ImGui::EndPopup();
    }
    if (ImGui::BeginPopup("drive")) {
        const std::string node =
            picture.nodes.empty() || menu_.index < 0 ? "" : picture.nodes[static_cast<std::size_t>(menu_.index)].name;
        ImGui::TextDisabled("%s drives a parameter of %s", new_name_.c_str(), node.c_str());
        if (bench_.plan() && menu_.index >= 0)
            for (const auto& [name, param] : bench_.plan()->nodes[static_cast<std::size_t>(menu_.index)].params)
                if (!param->is_structural && ImGui::MenuItem(name.c_str(), param->unit.c_str())) {
                    bench_.connect(new_name_, node + "." + name);
                    break;
                }
        ImGui::EndPopup();
    }
}

}  // namespace tactus::view
