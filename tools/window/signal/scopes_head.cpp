// SPDX-License-Identifier: Apache-2.0
// The line above a scope: its signal, what is shown of it, files, options.
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/signal/scopes.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

float button_width(const char* label) { return ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x; }

}  // namespace

bool Scopes::set_view(Scope& scope, Scope::View view) {
    if (scope.view == view) return false;
    scope.view = view;
    scope.computed_at = -1.0;
    scope.cursors.clear();
    return true;
}

void Scopes::set_column(Scope& scope, std::size_t column, bool is_magnitude) {
    scope.column = column;
    scope.is_magnitude = is_magnitude;
    scope.computed_at = -1.0;
    scope.cursors.clear();
}

void Scopes::head(Scope& scope, std::size_t index, const Feed& feed, bool& closes) {
    const float unit = ImGui::GetFontSize();
    const auto mark = [index](const char* what) { mark_spot(fmt::format("scope {} {}", index, what)); };
    // What does not fit into a narrow column is in the menu: closing and the names of signals never leave it.
    const float gap = ImGui::GetStyle().ItemSpacing.x, kind = 5.5f * unit, span_width = 5.0f * unit;
    const float freeze =
        ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("freeze").x + gap;
    const float files = button_width("CSV") + button_width("PNG") + 2.0f * gap;
    float room =
        ImGui::GetContentRegionAvail().x - kind - span_width - button_width("more") - button_width("×") - 4.0f * gap;
    const bool has_files = room - files > 4.0f * unit;
    if (has_files) room -= files;
    const bool has_freeze = room - freeze > 8.0f * unit;
    if (has_freeze) room -= freeze;
    ImGui::SetNextItemWidth(std::clamp(room, 3.0f * unit, 13.0f * unit));
    if (ImGui::BeginCombo("##port", scope.port.c_str())) {
        ImGui::InputTextWithHint("##search", "search", &search_);
        for (const Feed::Port& port : ports_) {
            if (port.name.find(search_) == std::string::npos) continue;
            if (!ImGui::Selectable(port.name.c_str(), port.name == scope.port)) continue;
            const Scope::View view = scope.view;
            scope = {};
            scope.port = port.name;
            scope.view = view;
        }
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    const auto shown = static_cast<std::size_t>(scope.view);
    if (ImGui::Button(view_names[shown], ImVec2(kind, 0)))
        set_view(scope, static_cast<Scope::View>((shown + 1) % std::size(view_names)));
    mark("kind");
    if (ImGui::IsItemHovered())
        show_tooltip(fmt::format("next: {}; right click: back", view_names[(shown + 1) % std::size(view_names)]));
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right))
        set_view(scope, static_cast<Scope::View>((shown + std::size(view_names) - 1) % std::size(view_names)));
    ImGui::SameLine();
    options(scope, index, has_freeze, has_files);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(span_width);
    auto span = static_cast<float>(scope.span);
    if (ImGui::DragFloat("##span", &span, 0.02f, 0.005f, static_cast<float>(LiveFeed::kept_s), "%.3g s",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
        scope.span = static_cast<double>(span);
        scope.computed_at = -1.0;
    }
    if (has_freeze) {
        ImGui::SameLine();
        ImGui::Checkbox("freeze", &scope.is_frozen);
        mark("freeze");
    }
    if (has_files) {
        ImGui::SameLine();
        const bool wants_csv = ImGui::SmallButton("CSV");
        mark("CSV");
        if (wants_csv) save(index, feed, ".csv");
        ImGui::SameLine();
        const bool wants_png = ImGui::SmallButton("PNG");
        mark("PNG");
        if (wants_png) save(index, feed, ".png");
    }
    ImGui::SameLine();
    closes |= ImGui::SmallButton("×");
    mark("close");
}

/// A menu: what the line has no room for, signals over this one, the column that is measured, and the trigger.
void Scopes::options(Scope& scope, std::size_t index, bool has_freeze, bool has_files) {
    if (ImGui::SmallButton("more")) ImGui::OpenPopup("options");
    mark_spot(fmt::format("scope {} options", index));
    if (!ImGui::BeginPopup("options")) return;
    if (!has_freeze) ImGui::MenuItem("Freeze", nullptr, &scope.is_frozen);
    if (!has_files)
        for (const auto& [label, ending] : {std::pair("Save as CSV", ".csv"), std::pair("Save as PNG", ".png")})
            if (ImGui::MenuItem(label)) scope.wants_file = ending;
    if (ImGui::BeginMenu("Draw another signal over it")) {
        for (const Feed::Port& port : ports_)
            if (ImGui::MenuItem(port.name.c_str())) add_overlay(scope, port.name);
        ImGui::EndMenu();
    }
    for (std::size_t i = 0; i < scope.others.size(); ++i)
        if (ImGui::MenuItem(fmt::format("Remove {}", scope.others[i]).c_str())) {
            remove_overlay(scope, i);
            break;
        }
    if (const std::size_t columns = display(scope.port).columns; columns == 3 && ImGui::BeginMenu("Measure")) {
        constexpr const char* names[] = {"x", "y", "z"};
        for (std::size_t c = 0; c < columns; ++c)
            if (ImGui::MenuItem(names[c], nullptr, !scope.is_magnitude && scope.column == c))
                set_column(scope, c, false);
        if (ImGui::MenuItem("magnitude", nullptr, scope.is_magnitude)) set_column(scope, 0, true);
        ImGui::EndMenu();
    }
    ImGui::Separator();
    if (ImGui::MenuItem("No trigger", nullptr, !scope.trigger)) scope.trigger.reset();
    for (const bool is_rising : {true, false}) {
        const bool is_chosen = scope.trigger && scope.trigger->is_rising == is_rising;
        if (ImGui::MenuItem(is_rising ? "Trigger where it rises" : "Trigger where it falls", nullptr, is_chosen))
            scope.trigger = Trigger{scope.trigger ? scope.trigger->level : 0.0, is_rising};
    }
    if (scope.trigger) {
        auto level = static_cast<float>(scope.trigger->level);
        const auto speed = static_cast<float>(0.005 * std::max(scope.plot.y.span(), 1e-9));
        ImGui::SetNextItemWidth(8.0f * ImGui::GetFontSize());
        if (ImGui::DragFloat("level", &level, speed, 0.0f, 0.0f, "%.4g"))
            scope.trigger->level = static_cast<double>(level);
    }
    ImGui::EndPopup();
}

}  // namespace tactus::window
