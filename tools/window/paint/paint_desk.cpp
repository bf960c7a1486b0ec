// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/paint_desk.hpp"

#include "assets/bone/labels.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/frame/whole_window.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::window {

using Tool = PaintBench::Tool;

namespace {

ImVec4 ink_of(const Vec3& colour) {
    return {static_cast<float>(colour.x), static_cast<float>(colour.y), static_cast<float>(colour.z), 1.0f};
}

}  // namespace

PaintDesk::PaintDesk(Window& window, PaintBench& bench)
    : window_(window),
      bench_(bench),
      slices_{SlicePanel(bench, sight_, Slice::axial), SlicePanel(bench, sight_, Slice::coronal),
              SlicePanel(bench, sight_, Slice::sagittal)},
      bone_(bench),
      fonts_{window.body, window.bold, window.large, window.scale()} {}

bool PaintDesk::button(const char* label, bool is_on) {
    if (is_on) ImGui::PushStyleColor(ImGuiCol_Button, faded(tone::chosen, 0.45));
    const bool pressed = ImGui::Button(label);
    if (is_on) ImGui::PopStyleColor();
    mark_spot(label);
    return pressed;
}

void PaintDesk::shortcuts() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    const auto pressed = [](char key) { return ImGui::IsKeyPressed(key, false); };
    if (io.KeyCtrl) {
        if (pressed('Z')) io.KeyShift ? bench_.painting().redo() : bench_.painting().undo();
        if (pressed('Y')) bench_.painting().redo();
        if (pressed('Q')) window_.close();
        return;
    }
    if (pressed('P')) bench_.tool = Tool::paint;
    if (pressed('E')) bench_.tool = Tool::erase;
    if (pressed('V')) bench_.tool = Tool::vessel;
    if (pressed('L')) bench_.look_here();
    if (pressed('I')) bench_.look_at_island();
    for (int key = 1; key <= 9; ++key)
        if (pressed(static_cast<char>('0' + key)) && static_cast<std::size_t>(key) <= bench_.painting().labels().size())
            bench_.painting().active = static_cast<std::size_t>(key) - 1;
}

void PaintDesk::draw_tools() {
    Painting& painting = bench_.painting();
    if (button("Paint", bench_.tool == Tool::paint)) bench_.tool = Tool::paint;
    ImGui::SameLine();
    if (button("Erase", bench_.tool == Tool::erase)) bench_.tool = Tool::erase;
    ImGui::SameLine();
    if (button("Vessel", bench_.tool == Tool::vessel)) bench_.tool = Tool::vessel;
    auto radius = static_cast<float>(bench_.brush * 1e3);
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderFloat("##brush", &radius, 0.5f, 20.0f, "brush %.1f mm", ImGuiSliderFlags_Logarithmic))
        bench_.brush = std::clamp(static_cast<double>(radius), 0.5, 20.0) * 1e-3;
    mark_spot("brush");
    if (button("Undo")) painting.undo();
    ImGui::SameLine();
    if (button("Redo")) painting.redo();
    ImGui::SameLine();
    if (button("Look here")) bench_.look_here();
    if (ImGui::IsItemHovered()) show_tooltip("the slices go to the largest region that is not sure: paint there next");
    if (const LiveLabelling* const found = bench_.labels().get(); found && !found->islands.empty()) {
        if (button("Next island")) bench_.look_at_island();
        if (ImGui::IsItemHovered())
            show_tooltip("the slices go to the next piece of bone without a seed; it has no label");
        ImGui::SameLine();
        ImGui::TextDisabled("%zu without a seed", found->islands.size());
    }
}

void PaintDesk::draw_labels() {
    Painting& painting = bench_.painting();
    const LiveLabelling* const found = bench_.labels().get();
    const Vec3& h = bench_.scan().box.spacing;
    int removed = -1;
    std::size_t merged = 0, merged_into = 0;
    for (std::size_t l = 0; l < painting.labels().size(); ++l) {
        const segmentation::SeedLabel& label = painting.labels()[l];
        ImGui::PushID(static_cast<int>(l));
        const Vec3 c = label.colour.value_or(Vec3(0.5));
        if (ImGui::ColorButton("##colour", ink_of(c), ImGuiColorEditFlags_NoTooltip)) ImGui::OpenPopup("colours");
        mark_spot("colour " + label.name);
        if (ImGui::BeginPopup("colours")) {
            for (int n = 1; n <= 8; ++n) {
                if (n % 4 != 1) ImGui::SameLine();
                ImGui::PushID(n);
                if (ImGui::ColorButton("##choice", ink_of(bone::label_colour(n)), ImGuiColorEditFlags_NoTooltip)) {
                    painting.recolour(l, bone::label_colour(n));
                    ImGui::CloseCurrentPopup();
                }
                ImGui::PopID();
            }
            ImGui::EndPopup();
        }
        ImGui::SameLine();
        const float wide = ImGui::GetContentRegionAvail().x - 2.2f * ImGui::GetFrameHeight();
        if (renamed_ == static_cast<int>(l)) {
            ImGui::SetNextItemWidth(wide);
            if (ImGui::InputText("##name", name_.data(), name_.size(), ImGuiInputTextFlags_EnterReturnsTrue)) {
                painting.rename(l, name_.data());
                renamed_ = -1;
            } else if (ImGui::IsItemDeactivated()) renamed_ = -1;
        } else {
            const bool is_chosen = ImGui::Selectable("##row", painting.active == l,
                                                     ImGuiSelectableFlags_AllowDoubleClick, ImVec2(wide, 0.0f));
            // Not as the row's own text, in which ImGui takes ## for the end.
            const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
            ImGui::PushClipRect(low, high, true);
            ImGui::GetWindowDrawList()->AddText(low, ImGui::GetColorU32(ImGuiCol_Text), label.name.c_str());
            ImGui::PopClipRect();
            if (is_chosen) {
                painting.active = l;
                if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
                    renamed_ = static_cast<int>(l);
                    std::snprintf(name_.data(), name_.size(), "%s", label.name.c_str());
                }
            }
            mark_spot("label " + label.name);
            if (ImGui::IsItemHovered()) show_tooltip(label.name + "\ndouble click: another name; right click: merge");
            if (ImGui::BeginPopupContextItem("merge")) {
                for (std::size_t into = 0; into < painting.labels().size(); ++into)
                    if (into != l &&
                        ImGui::MenuItem(
                            fmt::format("merge into {}###{}", painting.labels()[into].name, into).c_str())) {
                        merged = l;
                        merged_into = into;
                    }
                ImGui::EndPopup();
            }
        }
        ImGui::SameLine();
        if (ImGui::SmallButton("x")) removed = static_cast<int>(l);
        mark_spot("remove " + label.name);
        if (found && l < found->voxels.size())
            ImGui::TextDisabled("   %zu strokes, %.1f cm³", label.strokes.size(),
                                static_cast<double>(found->voxels[l]) * h.x * h.y * h.z * 1e6);
        else ImGui::TextDisabled("   %zu strokes", label.strokes.size());
        ImGui::PopID();
    }
    if (merged != merged_into) painting.merge(merged, merged_into);
    if (removed >= 0) painting.remove_label(static_cast<std::size_t>(removed));
    if (button("Add a fragment")) painting.add_label();
}

void PaintDesk::draw_vessels() {
    const auto& vessels = bench_.vessels();
    for (std::size_t n = 0; n < vessels.size(); ++n) {
        const LiveVessel& vessel = *vessels[n];
        if (vessel.number == 0 || vessel.track.branches.empty()) continue;
        bool is_taken = bench_.takes_vessel(n);
        const std::string name = fmt::format("vessel {}", vessel.number);
        if (ImGui::Checkbox(fmt::format("{}, {:.0f} mm###{}", name, vessel.track.length() * 1e3, name).c_str(),
                            &is_taken))
            bench_.take_vessel(n, is_taken);
        mark_spot(name);
        if (ImGui::IsItemHovered()) show_tooltip(vessel.words + "\nchecked: a plan that is made gets it");
    }
    if (!vessels.empty()) ImGui::Separator();
}

/// Closing would lose strokes that no file holds.
void PaintDesk::ask_leaving() {
    constexpr const char* title = "The strokes are not in the file";
    if (leaving == Leaving::asks && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted(bench_.painting().problem().c_str());
    if (button("Try again") && bench_.painting().save()) leaving = Leaving::leaves;
    ImGui::SameLine();
    if (button("Go on painting")) leaving = Leaving::none;
    ImGui::SameLine();
    if (button("Close and lose them")) leaving = Leaving::leaves;
    if (leaving != Leaving::asks) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void PaintDesk::draw_window() {
    ImGui::TextDisabled("grey values");
    auto low = static_cast<float>(bench_.window.low), high = static_cast<float>(bench_.window.high);
    const float speed = std::max(1e-6f, 0.005f * (high - low));
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::DragFloatRange2("##window", &low, &high, speed, 0.0f, 0.0f, "black %.4g", "white %.4g") && high > low)
        bench_.window = {static_cast<double>(low), static_cast<double>(high)};
    ImGui::Checkbox("show what is not sure", &bench_.shows_certainty);
    ImGui::Spacing();
    if (button("Make a plan") && !bench_.makes_plan()) bench_.make_plan();
    if (ImGui::IsItemHovered())
        show_tooltip("writes a bone per fragment, and a plan of them and of the vessels, beside the seeds");
    ImGui::Spacing();
    ImGui::PushStyleColor(ImGuiCol_Text, tone::dim);
    ImGui::TextWrapped(
        "left: paint; wheel: slice; ctrl + wheel: zoom; middle, or shift + left: move; right: grey values. P, E, V: "
        "tools; "
        "1 to 9: fragments; L: look here; I: next island; ctrl + Z: undo");
    if (!bench_.hand_words.empty()) ImGui::TextWrapped("%s", bench_.hand_words.c_str());
    for (const std::string& note : bench_.scan().notes) ImGui::TextWrapped("%s", note.c_str());
    ImGui::PopStyleColor();
}

void PaintDesk::draw() {
    bench_.tend();
    fonts_ = {window_.body, window_.bold, window_.large, window_.scale()};
    begin_whole_window("paint", fonts_);
    shortcuts();
    const double gap = 4.0 * fonts_.scale, side = 270.0 * fonts_.scale, line = 24.0 * fonts_.scale;
    const Point room = point(ImGui::GetContentRegionAvail());
    const double wide = std::max(16.0, 0.5 * (room.x - side - 2.0 * gap));
    const double high = std::max(16.0, 0.5 * (room.y - line - 2.0 * gap));
    const auto panel = [&](const char* id, bool is_second, const auto& content) {
        if (is_second) ImGui::SameLine(0.0f, static_cast<float>(gap));
        ImGui::BeginChild(id, vec({wide, high}), false,
                          ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
        content();
        ImGui::EndChild();
    };
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({gap, gap}));
    ImGui::BeginGroup();
    panel("axial", false, [&] { slices_[0].draw(fonts_); });
    panel("bone", true, [&] { bone_.draw(fonts_); });
    panel("coronal", false, [&] { slices_[1].draw(fonts_); });
    panel("sagittal", true, [&] { slices_[2].draw(fonts_); });
    ImGui::EndGroup();
    ImGui::PopStyleVar();
    ImGui::SameLine(0.0f, static_cast<float>(gap));
    ImGui::BeginChild("tools", vec({0.0, 2.0 * high + gap}), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    draw_tools();
    ImGui::Separator();
    draw_labels();
    ImGui::Separator();
    draw_vessels();
    draw_window();
    ImGui::EndChild();
    ImGui::PushStyleColor(ImGuiCol_Text, bench_.is_problem() ? tone::bad : bench_.is_busy() ? tone::warm : tone::dim);
    ImGui::TextUnformatted(bench_.message().c_str());
    ImGui::PopStyleColor();
    ask_leaving();
    ImGui::End();
    ImGui::PopFont();
}

}  // namespace tactus::window
