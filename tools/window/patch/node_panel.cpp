// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/node_panel.hpp"

#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/window/document/part_ports.hpp"
#include "tools/window/frame/elide.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/patch/type_search.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

using Kind = ParameterField::Kind;

void tip(const std::string& text) {
    if (!text.empty() && ImGui::IsItemHovered()) show_tooltip(text);
}

void dim(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, tone::dim);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

/// A range as wide as the number type is not shown.
std::string range_text(const ParameterField& field) {
    constexpr double endless = 1e12;
    if (field.least <= -endless && field.most >= endless) return "any number";
    return fmt::format("{:.4g} … {:.4g}", field.least, field.most);
}

std::string explanation(const ParameterField& field) {
    std::string text = field.about;
    if (field.kind == Kind::quantity)
        text += fmt::format("\n{}{}{}, default {}", range_text(field), field.unit.empty() ? "" : " ", field.unit,
                            field.standard);
    else if (!field.standard.empty()) text += fmt::format("\ndefault {}", field.standard);
    if (field.is_driven) text += "\ndriven by a wire";
    else if (!field.is_live) text += "\nstructural: a change restarts the node";
    return text;
}

/// True when a linear slider would be too coarse for typical values.
bool is_logarithmic(const ParameterField& field) {
    if (field.least > 0.0) return field.most / field.least > 1e3;
    return field.least == 0.0 && field.normal > 0.0 && field.most / field.normal > 100.0;
}

/// Marks the default below the last slider.
void mark_default(const ParameterField& field) {
    if (!(field.most > field.least)) return;
    const auto share = [&](double x) {
        if (!is_logarithmic(field)) return (x - field.least) / (field.most - field.least);
        // Near zero a logarithmic slider starts at the last displayed digit.
        const double least = field.least > 0.0 ? field.least : 1e-5;
        return std::log(std::max(x, least) / least) / std::log(field.most / least);
    };
    const Point low = point(ImGui::GetItemRectMin()), high = point(ImGui::GetItemRectMax());
    const double grab = static_cast<double>(ImGui::GetStyle().GrabMinSize);
    const double x = low.x + 0.5 * grab + std::clamp(share(field.normal), 0.0, 1.0) * (high.x - low.x - grab);
    ImGui::GetWindowDrawList()->AddLine(vec({x, high.y - 4.0}), vec({x, high.y}), tone::dim, 2.0f);
}

}  // namespace

void NodePanel::quantity(const ParameterField& field, const std::string& node) {
    const std::string id = node + "." + field.name;
    double value = turning_ == id ? turned_to_ : field.value;
    const bool is_wide = is_logarithmic(field);
    const std::string format = fmt::format("%.5g {}", field.unit == "%" ? "%%" : field.unit);
    const std::optional<double> speed = drag_speed(field);
    const bool moved = speed ? ImGui::DragScalar("##value", ImGuiDataType_Double, &value, static_cast<float>(*speed),
                                                 &field.least, &field.most, format.c_str())
                             : ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &field.least, &field.most,
                                                   format.c_str(), is_wide ? ImGuiSliderFlags_Logarithmic : 0);
    mark_spot(field.name);
    if (moved) {
        turning_ = id;
        turned_to_ = std::clamp(value, field.least, field.most);
        turned_ = quantity_text(turned_to_, field.unit);
        if (field.is_live) bench_.turn(node, field.name, turned_);
    }
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(explanation(field) +
        (speed ? "\ndrag: Shift is faster, Alt finer; Ctrl-click to type" : "\nCtrl-click to type"));
    if (!speed) mark_default(field);
    if (ended && turning_ == id) {
        turning_.clear();
        set_turned(field, node);
    }
}

void NodePanel::set_turned(const ParameterField& field, const std::string& node) {
    if (!bench_.set(node, field.name, turned_) && field.is_live) bench_.turn(node, field.name, field.text);
}

void NodePanel::field(const ParameterField& field, const std::string& node) {
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    const std::string name = elided(field.name, static_cast<double>(ImGui::GetContentRegionAvail().x));
    if (field.is_set) ImGui::TextUnformatted(name.c_str());
    else ImGui::TextDisabled("%s", name.c_str());
    tip(name == field.name ? explanation(field) : field.name + "\n" + explanation(field));
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1.0f);
    const std::string refused = refusal(field, node);
    ImGui::BeginDisabled(is_read_only || field.is_driven || !refused.empty());
    switch (field.kind) {
        case Kind::quantity: quantity(field, node); break;
        case Kind::asset: asset(field, node); break;
        case Kind::choice:
            if (ImGui::BeginCombo("##value", field.text.empty() ? "none" : field.text.c_str())) {
                for (const std::string& option : field.options)
                    if (ImGui::Selectable(option.c_str(), option == field.text)) bench_.set(node, field.name, option);
                ImGui::EndCombo();
            }
            tip(explanation(field));
            break;
        case Kind::flag: {
            bool on = field.text == "true";
            const bool turned = ImGui::Checkbox("##value", &on);
            mark_spot(field.name);
            if (turned) bench_.set(node, field.name, on ? "true" : "false");
            tip(explanation(field));
            break;
        }
        case Kind::text:
        case Kind::vector: {
            const std::string id = node + "." + field.name;
            std::string text = turning_ == id ? typed_ : field.text;
            if (ImGui::InputText("##value", &text)) {
                turning_ = id;
                turned_ = typed_ = text;
            }
            mark_spot(field.name);
            const bool ended = ImGui::IsItemDeactivatedAfterEdit();
            tip(explanation(field));
            if (ended && turning_ == id) {
                turning_.clear();
                bench_.set(node, field.name, typed_);
            }
            break;
        }
    }
    ImGui::EndDisabled();
    if (!refused.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) show_tooltip(refused);
    ImGui::TableNextColumn();
    if (field.kind == Kind::quantity) {
        ImGui::AlignTextToFramePadding();
        const std::string range = range_text(field);
        const std::string shown = elided(range, static_cast<double>(ImGui::GetContentRegionAvail().x));
        ImGui::TextDisabled("%s", shown.c_str());
        tip(shown == range ? explanation(field) : range + "\n" + explanation(field));
    }
    ImGui::TableNextColumn();
    if (field.is_set && !is_read_only && refused.empty()) {
        const bool pressed = ImGui::SmallButton("↺");
        mark_spot("reset " + field.name);
        if (pressed) bench_.reset(node, field.name);
        tip("back to the default, " + (field.standard.empty() ? "none" : field.standard));
    }
}

std::string NodePanel::refusal(const ParameterField& field, const std::string& node) const {
    const std::size_t within = node.find(patch::within_node);
    if (within == std::string::npos || !bench_.offered_as(node, field.name).empty()) return {};
    return fmt::format("'{}' does not offer this parameter; set it in the file of that patch", node.substr(0, within));
}

void NodePanel::read_fields(const PictureNode& node) {
    fields_.clear();
    const auto& nodes = bench_.written().nodes;
    const auto part = std::ranges::find(nodes, node.name, &patch::PatchNode::name);
    if (part != nodes.end() && patch::is_sub_patch(*part)) {
        fields_ = parameters_of_part(bench_.written(), *part);
        return;
    }
    if (node.plan >= 0) {
        fields_ = parameters_of(*bench_.plan(), node.plan);
        return;
    }
    const auto type = std::ranges::find(nodes::catalogue(), node.type, [](const NodeType* t) { return t->name; });
    const auto& written = bench_.written().nodes;
    const auto known = std::ranges::find(written, node.name, &patch::PatchNode::name);
    if (type != nodes::catalogue().end() && known != written.end())
        fields_ = parameters_of(**type, bench_.written(), *known);
}

void NodePanel::end_typing(std::string& selected) {
    const std::string node = shown_, param = std::exchange(turning_, {});
    const bool renames = std::exchange(is_renaming_, false);
    if (is_read_only || bench_.picture().find(node) < 0) return;
    constexpr std::string_view device = "device ";
    if (param.starts_with(node + ".")) {
        const auto field = std::ranges::find(fields_, param.substr(node.size() + 1), &ParameterField::name);
        if (field != fields_.end()) set_turned(*field, node);
    } else if (param.starts_with(device)) {
        const std::size_t dot = param.find('.');
        bench_.set_device(param.substr(device.size(), dot - device.size()), param.substr(dot + 1), turned_);
    }
    if (renames && renaming_ != node && bench_.rename(node, renaming_) && selected == node) selected = renaming_;
}

void NodePanel::draw_parameters(std::string& selected, const Fonts& fonts) {
    // Another node is chosen: what was being typed for the one before is set there.
    if (shown_ != selected) {
        end_typing(selected);
        shown_.clear();
    }
    const int index = bench_.picture().find(selected);
    if (index < 0) return dim("Click a node of the patch to show its parameters here.");
    if (version_ != bench_.plan_version() || shown_ != selected) {
        read_fields(bench_.picture().nodes[static_cast<std::size_t>(index)]);
        version_ = bench_.plan_version();
        shown_ = renaming_ = selected;
    }
    const PictureNode node = bench_.picture().nodes[static_cast<std::size_t>(index)];
    const auto type = std::ranges::find(nodes::catalogue(), node.type, [](const NodeType* t) { return t->name; });
    ImGui::PushFont(fonts.bold);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
    if (ImGui::InputText("##name", &renaming_, is_read_only ? ImGuiInputTextFlags_ReadOnly : 0)) is_renaming_ = true;
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    if (ended) is_renaming_ = false;
    const bool renamed = ended && renaming_ != selected;
    mark_spot("name");
    ImGui::PopFont();
    ImGui::SameLine();
    const std::string lane = bench_.picture().lanes[static_cast<std::size_t>(node.group)].name;
    if (is_read_only || !bench_.has_lane(node.name)) ImGui::TextDisabled("%s, %s", node.type.c_str(), lane.c_str());
    else draw_lane(node.name, lane);
    if (type != nodes::catalogue().end()) dim(std::string((*type)->about));
    else if (!node.type.empty()) dim(node.type);
    if (!node.lacks.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, node.is_at_fault ? tone::bad : tone::warm);
        ImGui::TextWrapped(node.is_at_fault ? "Cannot be made: %s." : "Does not run yet: %s.", node.lacks.c_str());
        ImGui::PopStyleColor();
    }
    const auto status = bench_.status();
    const auto time = std::ranges::find(status->nodes, selected, &NodeStatus::name);
    if (time != status->nodes.end() && time->mean_us > 0.0)
        dim(fmt::format("{:.2f} µs a call, at most {:.1f} µs, {:.2f} % of its period", time->mean_us, time->max_us,
                        100.0 * time->share));
    ImGui::Spacing();
    if (fields_.empty()) dim("no parameters");
    if (ImGui::BeginTable("fields", 4, ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 0.30f);
        ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.48f);
        ImGui::TableSetupColumn("range", ImGuiTableColumnFlags_WidthStretch, 0.22f);
        ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, 1.6f * ImGui::GetFontSize());
        const std::string name = selected;
        const std::vector<ParameterField> fields = fields_;
        for (const ParameterField& each : fields) {
            ImGui::PushID(each.name.c_str());
            ImGui::TableNextRow();
            field(each, name);
            ImGui::PopID();
        }
        ImGui::EndTable();
    }
    draw_device(node);
    ImGui::Spacing();
    if (!is_read_only && ImGui::Button("Remove the node")) bench_.remove(selected);
    if (renamed) {
        if (bench_.rename(selected, renaming_)) selected = renaming_;
        else renaming_ = selected;
    }
}

/// The lane of a node, to choose among those of the patch, or a rate that is typed.
void NodePanel::draw_lane(const std::string& node, const std::string& lane) {
    ImGui::SetNextItemWidth(-1.0f);
    const bool is_open = ImGui::BeginCombo("##lane", lane.c_str(), ImGuiComboFlags_HeightLargest);
    mark_spot("lane");
    if (!is_open) return tip("rate or group: where it runs");
    std::string wanted;
    std::vector<std::string> lanes;
    for (const PictureLane& each : bench_.picture().lanes)
        if (each.name.find(patch::within_node) == std::string::npos) lanes.push_back(each.name);
    for (const patch::PatchGroup& group : bench_.written().groups)
        if (std::ranges::find(lanes, group.name) == lanes.end()) lanes.push_back(group.name);
    for (const std::string& each : lanes) {
        if (ImGui::Selectable(each.c_str(), each == lane)) wanted = each;
        mark_spot("lane " + each);
    }
    ImGui::SetNextItemWidth(9.0f * ImGui::GetFontSize());
    if (ImGui::InputTextWithHint("##rate", "a rate, as 2 kHz", &typed_rate_, ImGuiInputTextFlags_EnterReturnsTrue)) {
        wanted = std::exchange(typed_rate_, {});
        ImGui::CloseCurrentPopup();
    }
    mark_spot("lane rate");
    ImGui::EndCombo();
    if (!wanted.empty() && wanted != lane) bench_.move_to_lane({node}, wanted);
}

void NodePanel::draw_catalogue(std::string& selected) {
    if (is_read_only) return dim("A take is read-only; run the patch to change it.");
    const auto& lanes = bench_.picture().lanes;
    const auto known = std::ranges::find(lanes, lane_, &PictureLane::name);
    if (known == lanes.end()) lane_.clear();
    constexpr const char* usual = "their usual rate";
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
    ImGui::InputTextWithHint("##search", "search by name or purpose", &search);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::BeginCombo("##group", lane_.empty() ? usual : lane_.c_str())) {
        if (ImGui::Selectable(usual, lane_.empty())) lane_.clear();
        for (const PictureLane& lane : lanes)
            if (lane.name.find(patch::within_node) == std::string::npos &&
                ImGui::Selectable(lane.name.c_str(), lane.name == lane_))
                lane_ = lane.name;
        ImGui::EndCombo();
    }
    ImGui::BeginChild("types");
    std::string chosen;
    for (const NodeType* type : types_for(search, nullptr)) {
        if (ImGui::Selectable(type->name.c_str())) chosen = type->name;
        if (ImGui::BeginDragDropSource()) {
            ImGui::SetDragDropPayload(dragged_type, type->name.data(), type->name.size());
            ImGui::TextUnformatted(type->name.c_str());
            ImGui::EndDragDropSource();
        }
        mark_spot("type " + type->name);
        tip(std::string(type->about) + "\nclick, or drag it into the patch");
        ImGui::SameLine(11.0f * ImGui::GetFontSize());
        ImGui::TextDisabled("%.*s", static_cast<int>(type->about.size()), type->about.data());
    }
    ImGui::EndChild();
    if (chosen.empty()) return;
    const std::string lane = lane_.empty() ? bench_.lane_for(chosen) : lane_;
    if (const std::string made = bench_.add_node(chosen, lane); !made.empty()) selected = made;
}

}  // namespace tactus::window
