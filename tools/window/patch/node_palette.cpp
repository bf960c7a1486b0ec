// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/node_palette.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace tactus::window {

namespace {

constexpr const char* popup = "add a node here";

bool key(ImGuiKey_ which) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(which)); }

}  // namespace

void NodePalette::open(Point at, Point world, const std::string& from, const ValueType* type) {
    wants_open_ = true;
    at_ = at;
    world_ = world;
    from_ = from;
    type_ = type;
    words_.clear();
    lane_.clear();
    chosen_ = 0;
    found_ = types_for("", type);
}

std::string NodePalette::add(const NodeType& type) {
    const std::string lane = lane_.empty() ? bench_.lane_for(type.name) : lane_;
    const PicturePort* input = from_.empty() ? nullptr : input_for(type, type_);
    return bench_.add_node(type.name, lane, place_for(bench_.picture(), lane, world_), from_,
                           input ? input->name : std::string());
}

void NodePalette::preview(const NodeType& type) const {
    const TypePorts* ports = ports_of_type(type.name);
    ImGui::TextUnformatted(type.name.c_str());
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%.*s", static_cast<int>(type.about.size()), type.about.data());
    ImGui::PopTextWrapPos();
    if (!ports) return;
    const auto list = [](const char* what, const std::vector<PicturePort>& all) {
        for (const PicturePort& port : all) {
            ImGui::PushStyleColor(ImGuiCol_Text, colour_of(port.type));
            ImGui::TextUnformatted(what);
            ImGui::PopStyleColor();
            ImGui::SameLine();
            ImGui::Text("%s%s", port.name.c_str(), port.is_optional || what[0] == 'o' ? "" : " *");
            ImGui::SameLine();
            const std::string kind(port.type ? port.type->name : "any");
            ImGui::TextDisabled("%s%s%s", kind.c_str(), port.unit.empty() ? "" : ", ", port.unit.c_str());
        }
    };
    list("in ", ports->inputs);
    list("out", ports->outputs);
}

std::string NodePalette::draw(const Fonts& fonts) {
    if (std::exchange(wants_open_, false)) {
        ImGui::OpenPopup(popup);
        const Point size{540.0 * fonts.scale, 320.0 * fonts.scale};
        const Point all = point(ImGui::GetMainViewport()->Size);
        ImGui::SetNextWindowPos(vec({std::clamp(at_.x, 0.0, std::max(0.0, all.x - size.x)),
                                     std::clamp(at_.y, 0.0, std::max(0.0, all.y - size.y))}));
        ImGui::SetNextWindowSize(vec({std::min(size.x, all.x), std::min(size.y, all.y)}));
    }
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({8.0 * fonts.scale, 8.0 * fonts.scale}));
    const bool is_open = ImGui::BeginPopup(popup, ImGuiWindowFlags_NoMove);
    ImGui::PopStyleVar();
    if (!is_open) return {};
    std::string made;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.62f);
    if (ImGui::InputTextWithHint("##words", "name, purpose, parameter or unit", &words_)) {
        found_ = types_for(words_, type_);
        chosen_ = 0;
    }
    mark_spot("palette");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::BeginCombo("##lane", lane_.empty() ? "its usual rate" : lane_.c_str())) {
        if (ImGui::Selectable("its usual rate", lane_.empty())) lane_.clear();
        for (const PictureLane& lane : bench_.picture().lanes)
            if (ImGui::Selectable(lane.name.c_str(), lane.name == lane_)) lane_ = lane.name;
        for (const char* rate : {"60 Hz", "1 kHz", "48 kHz"})
            if (std::ranges::find(bench_.picture().lanes, rate, &PictureLane::name) == bench_.picture().lanes.end() &&
                ImGui::Selectable(rate, lane_ == rate))
                lane_ = rate;
        ImGui::EndCombo();
    }
    const bool goes_down = key(ImGuiKey_DownArrow), goes_up = key(ImGuiKey_UpArrow);
    if (goes_down && chosen_ + 1 < found_.size()) ++chosen_;
    if (goes_up && chosen_ > 0) --chosen_;
    const NodeType* wanted = nullptr;
    ImGui::BeginChild("found", ImVec2(ImGui::GetContentRegionAvail().x * 0.42f, 0.0f));
    for (std::size_t i = 0; i < found_.size(); ++i) {
        if (ImGui::Selectable(found_[i]->name.c_str(), i == chosen_)) wanted = found_[i];
        mark_spot("found " + found_[i]->name);
        if (ImGui::IsItemHovered() && (ImGui::GetIO().MouseDelta.x != 0.0f || ImGui::GetIO().MouseDelta.y != 0.0f))
            chosen_ = i;
        if (i == chosen_ && (goes_down || goes_up)) ImGui::SetScrollHereY();
    }
    if (found_.empty()) ImGui::TextDisabled("nothing suits; try another word");
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("ports");
    if (chosen_ < found_.size()) preview(*found_[chosen_]);
    ImGui::EndChild();
    if (!wanted && chosen_ < found_.size() && (key(ImGuiKey_Enter) || key(ImGuiKey_KeyPadEnter)))
        wanted = found_[chosen_];
    if (wanted) made = add(*wanted);
    if (wanted || key(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return made;
}

}  // namespace tactus::window
