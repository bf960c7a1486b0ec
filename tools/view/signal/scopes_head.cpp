// SPDX-License-Identifier: Apache-2.0
// The line above a scope: its signal, what is shown of it, files, options.
#include "dsp/core/error.hpp"
#include "tools/view/signal/scopes.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace tactus::view {

/// In the folder of the run; without one in the current folder.
std::filesystem::path Scopes::free_file(const std::string& port, const std::string& ending) const {
    std::string name = port;
    std::ranges::replace(name, '/', '-');  // of a sub-patch
    std::filesystem::path path;
    for (int i = 1; path.empty() || std::filesystem::exists(path); ++i)
        path = bench_.status()->folder / fmt::format("{}-{}{}", name, i, ending);
    return path;
}

void Scopes::head(Scope& scope, std::size_t index, const Feed& feed, bool& closes) {
    const float unit = ImGui::GetFontSize();
    const auto mark = [index](const char* what) { mark_spot(fmt::format("scope {} {}", index, what)); };
    ImGui::SetNextItemWidth(13.0f * unit);
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
    constexpr const char* views[] = {"wave", "spectrum", "waterfall", "histogram", "x-y"};
    const auto shown = static_cast<std::size_t>(scope.view);
    if (ImGui::Button(views[shown], ImVec2(5.5f * unit, 0))) {
        scope.view = static_cast<Scope::View>((shown + 1) % std::size(views));
        scope.computed_at = -1.0;
        scope.cursors.clear();
    }
    mark("kind");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("next: %s; right click: back", views[(shown + 1) % std::size(views)]);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
        scope.view = static_cast<Scope::View>((shown + std::size(views) - 1) % std::size(views));
        scope.computed_at = -1.0;
        scope.cursors.clear();
    }
    ImGui::SameLine();
    options(scope, index);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(5.0f * unit);
    auto span = static_cast<float>(scope.span);
    if (ImGui::DragFloat("##span", &span, 0.02f, 0.005f, static_cast<float>(LiveFeed::kept_s), "%.3g s",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
        scope.span = static_cast<double>(span);
        scope.computed_at = -1.0;
    }
    ImGui::SameLine();
    ImGui::Checkbox("freeze", &scope.is_frozen);
    mark("freeze");
    const auto save_as = [&](const char* ending) {
        try {
            write(index, feed, free_file(scope.port, ending));
        } catch (const Error& error) {
            bench_.tell(error.what(), true);
        }
    };
    ImGui::SameLine();
    const bool wants_csv = ImGui::SmallButton("CSV");
    mark("CSV");
    if (wants_csv) save_as(".csv");
    ImGui::SameLine();
    const bool wants_png = ImGui::SmallButton("PNG");
    mark("PNG");
    if (wants_png) save_as(".png");
    ImGui::SameLine();
    closes = ImGui::SmallButton("×");
    mark("close");
}

/// A menu: signals over this one, and the trigger.
void Scopes::options(Scope& scope, std::size_t index) {
    if (ImGui::SmallButton("more")) ImGui::OpenPopup("options");
    mark_spot(fmt::format("scope {} options", index));
    if (!ImGui::BeginPopup("options")) return;
    if (ImGui::BeginMenu("Draw another signal over it")) {
        for (const Feed::Port& port : ports_)
            if (ImGui::MenuItem(port.name.c_str())) {
                scope.others.push_back(port.name);
                scope.computed_at = -1.0;
            }
        ImGui::EndMenu();
    }
    for (std::size_t i = 0; i < scope.others.size(); ++i)
        if (ImGui::MenuItem(fmt::format("Remove {}", scope.others[i]).c_str())) {
            scope.others.erase(scope.others.begin() + static_cast<std::ptrdiff_t>(i));
            scope.held_others.clear();
            scope.held.reset();
            break;
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

}  // namespace tactus::view
