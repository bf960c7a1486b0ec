// SPDX-License-Identifier: Apache-2.0
// Assets and devices of the selected node.
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/patch/node_panel.hpp"

#include "devices/haptic/catalogue.hpp"
#include "nodes/catalogue.hpp"
#include "tools/window/document/start_list.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace tactus::window {

namespace fs = std::filesystem;

void NodePanel::asset(const ParameterField& field, const std::string& node) {
    if (ImGui::BeginCombo("##value", field.text.empty() ? "none" : field.text.c_str())) {
        for (const std::string& option : field.options)
            if (ImGui::Selectable(option.c_str(), option == field.text)) bench_.set(node, field.name, option);
        if (ImGui::Selectable("a file...") && ask_file) {
            const fs::path& file = bench_.editor().file();
            ask_file(
                fmt::format("A {} for {}", field.type, node),
                FileChooser(FileChooser::For::open, fs::absolute(file).parent_path(), endings_of_asset(field.type)),
                [this, node, name = field.name](const fs::path& path) { bench_.use_file(node, name, path); });
        }
        mark_spot("file of " + field.name);
        ImGui::EndCombo();
    }
    mark_spot(field.name);
    if (ImGui::IsItemHovered()) show_tooltip(field.about);
}

void NodePanel::draw_device(const PictureNode& node) {
    const auto type = std::ranges::find(nodes::catalogue(), node.type, [](const NodeType* t) { return t->name; });
    if (type == nodes::catalogue().end()) return;
    if ((*type)->role != NodeRole::hand_source && (*type)->role != NodeRole::hand_sink) return;
    const auto& devices = bench_.written().devices;
    const auto named = std::ranges::find(fields_, "device", &ParameterField::name);
    const std::string wanted = named == fields_.end() ? "" : named->text;
    const auto found = wanted.empty() && devices.size() == 1
                           ? devices.begin()
                           : std::ranges::find(devices, wanted, &patch::PatchDevice::name);
    if (found == devices.end()) return;
    const patch::PatchDevice device = *found;
    ImGui::Spacing();
    ImGui::TextDisabled("device %s", device.name.c_str());
    ImGui::BeginDisabled(is_read_only);
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    if (ImGui::BeginCombo("driver", device.driver.c_str())) {
        for (const haptic::HapticDriver& driver : haptic::haptic_drivers()) {
            if (ImGui::Selectable(driver.name.c_str(), driver.name == device.driver))
                bench_.set_driver(device.name, driver.name);
            if (ImGui::IsItemHovered()) show_tooltip(driver.summary);
        }
        ImGui::EndCombo();
    }
    mark_spot("driver");
    for (const OptionText& setting : device.settings) {
        ImGui::PushID(setting.name.c_str());
        const std::string id = "device " + device.name + "." + setting.name;
        std::string text = turning_ == id ? typed_ : setting.text;
        ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
        if (ImGui::InputText(setting.name.c_str(), &text)) {
            turning_ = id;
            turned_ = typed_ = text;
        }
        mark_spot("device " + setting.name);
        if (ImGui::IsItemDeactivatedAfterEdit() && turning_ == id) {
            turning_.clear();
            bench_.set_device(device.name, setting.name, typed_);
        }
        ImGui::PopID();
    }
    const float wide = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(0.3f * wide);
    ImGui::InputTextWithHint("##option", "setting", &device_option_);
    mark_spot("device setting");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(0.4f * wide);
    const bool entered = ImGui::InputTextWithHint("##new value", "value, as 60 mm", &device_value_,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    mark_spot("device value");
    ImGui::SameLine();
    const bool pressed = ImGui::Button("Set");
    mark_spot("set device");
    if ((entered || pressed) && !device_option_.empty() &&
        bench_.set_device(device.name, device_option_, device_value_)) {
        device_option_.clear();
        device_value_.clear();
    }
    ImGui::EndDisabled();
}

}  // namespace tactus::window
