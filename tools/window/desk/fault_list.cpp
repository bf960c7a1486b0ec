// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/fault_list.hpp"

#include "tools/window/frame/elide.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace tactus::window {

namespace {

struct Repair {
    std::string label, spot;
    std::function<void(Workbench&)> make;
};

std::vector<Repair> repairs_of(const Fault& fault) {
    std::vector<Repair> repairs;
    if (!fault.suggestion.empty() && fault.line > 0)
        repairs.push_back({fmt::format("Use '{}'", fault.suggestion), "correct",
                           [fault](Workbench& bench) { bench.correct(fault); }});
    if (!fault.param.empty())
        repairs.push_back({fmt::format("Remove '{}'", fault.param), "reset",
                           [fault](Workbench& bench) { bench.reset(fault.node, fault.param); }});
    else if (fault.wire)
        repairs.push_back({"Remove the wire", "remove", [fault](Workbench& bench) {
                               const patch::PatchWire& wire = *fault.wire;
                               const std::string from = wire.from_node + (wire.from_port.empty() ? "" : ".");
                               bench.disconnect(wire.to_node + "." + wire.to_port, from + wire.from_port);
                           }});
    else if (!fault.node.empty())
        repairs.push_back({"Remove the node", "remove", [fault](Workbench& bench) { bench.remove(fault.node); }});
    else if (fault.line > 0)
        repairs.push_back(
            {"Remove the line", "remove", [fault](Workbench& bench) { bench.replace_line(fault.line, std::nullopt); }});
    return repairs;
}

float width_of(const Repair& repair) {
    return ImGui::CalcTextSize(repair.label.c_str()).x + 2.0f * ImGui::GetStyle().FramePadding.x +
           ImGui::GetStyle().ItemSpacing.x;
}

}  // namespace

double FaultList::height(double room, const Fonts& fonts) const {
    if (!bench_.is_broken()) return 0.0;
    const double head = 26.0, each = 50.0;
    const double wanted = head + each * static_cast<double>(bench_.faults().size());
    return std::min(wanted * fonts.scale, 0.4 * room);
}

std::string FaultList::draw(double height, const Fonts& fonts) {
    const double s = fonts.scale;
    if (version_ != bench_.plan_version()) {
        version_ = bench_.plan_version();
        lines_.clear();
        for (const Fault& fault : bench_.faults()) lines_.push_back(bench_.line(fault.line));
    }
    std::string wanted;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({8.0 * s, 4.0 * s}));
    ImGui::PushStyleColor(ImGuiCol_ChildBg, colour(0x2a1d22));
    ImGui::BeginChild("errors", vec({0.0, height}), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleVar();
    const Point at = point(ImGui::GetWindowPos()), far = at + point(ImGui::GetWindowSize());
    set_spot("panel errors", {at.x, at.y, far.x, far.y});
    ImGui::PushFont(fonts.bold);
    const std::size_t count = bench_.faults().size();
    ImGui::TextUnformatted((count == 1 ? std::string("1 error") : fmt::format("{} errors", count))
                               .append(": the patch does not run")
                               .c_str());
    ImGui::PopFont();
    for (std::size_t i = 0; i < count; ++i) {
        ImGui::PushID(static_cast<int>(i));
        draw_fault(i, bench_.faults()[i], wanted);
        ImGui::PopID();
    }
    ImGui::EndChild();
    ImGui::PopStyleColor();
    // A repair changes the list.
    if (repair_) std::exchange(repair_, nullptr)();
    return wanted;
}

void FaultList::draw_fault(std::size_t index, const Fault& fault, std::string& wanted) {
    const std::string words = fault.line > 0       ? fmt::format("line {}: {}", fault.line, fault.message)
                              : fault.file.empty() ? fault.message
                                                   : fault.text;
    const std::string shown = elided(words, static_cast<double>(ImGui::GetContentRegionAvail().x));
    ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
    const bool is_clicked = ImGui::Selectable(shown.c_str());
    ImGui::PopStyleColor();
    mark_spot(fmt::format("error {}", index + 1));
    if (ImGui::IsItemHovered())
        show_tooltip((shown == words ? std::string() : words + "\n") + "click: show where it is");
    const auto has = [&](const std::string& node) { return bench_.picture().find(node) >= 0; };
    if (is_clicked) {
        wanted = fault.node;
        if (fault.wire) wanted = has(fault.wire->to_node) ? fault.wire->to_node : fault.wire->from_node;
    }
    draw_repairs(index, fault);
}

void FaultList::draw_repairs(std::size_t index, const Fault& fault) {
    const std::vector<Repair> repairs = repairs_of(fault);
    float buttons = 0.0f;
    for (const Repair& repair : repairs) buttons += width_of(repair);
    bool is_first = true;
    if (fault.line > 0) {
        ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - buttons, 8.0f * ImGui::GetFontSize()));
        ImGui::InputText("##line", &lines_[index]);
        mark_spot(fmt::format("error {} line", index + 1));
        if (ImGui::IsItemDeactivatedAfterEdit())
            repair_ = [this, line = fault.line, text = lines_[index]] { bench_.replace_line(line, text); };
        is_first = false;
    }
    for (const Repair& repair : repairs) {
        if (!std::exchange(is_first, false)) ImGui::SameLine();
        if (ImGui::Button(repair.label.c_str())) repair_ = [this, make = repair.make] { make(bench_); };
        mark_spot(fmt::format("error {} {}", index + 1, repair.spot));
    }
}

}  // namespace tactus::window
