// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/state_banner.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

namespace tactus::window {

namespace {

// A hand that passes through a bone at the start, or a ramp, is not told.
constexpr double told_after_s = 0.5;

bool is_told(const run::HandForces& forces, double now_s) {
    using control::ForceState;
    if (forces.state <= ForceState::ramps) return false;
    return control::is_off(forces.state) || now_s - forces.since_s > told_after_s;
}

}  // namespace

void state_banner(Workbench& bench, const Fonts& fonts) {
    const auto status = bench.status();
    const bool runs = status->state == RunStatus::State::runs;
    bool is_needed = false;
    for (const run::HandForces& forces : status->forces)
        is_needed = is_needed || (runs && is_told(forces, status->time));
    if (!is_needed) return;
    const auto gap = static_cast<float>(8.0 * fonts.scale);
    const ImVec2 screen = ImGui::GetMainViewport()->Size;
    // Over the messages, which it repeats: no control is below it.
    ImGui::SetNextWindowPos(ImVec2(gap, screen.y - gap), ImGuiCond_Always, ImVec2(0.0f, 1.0f));
    const float wide = screen.x - 2.0f * gap;
    ImGui::SetNextWindowSizeConstraints(ImVec2(wide, static_cast<float>(38.0 * fonts.scale)), ImVec2(wide, screen.y));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(gap, 0.6f * gap));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colour(0x3a1d22));
    ImGui::Begin("state", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushTextWrapPos(screen.x - 4.0f * gap);
    for (const run::HandForces& forces : status->forces) {
        if (!is_told(forces, status->time)) continue;
        const bool has_button = forces.state == control::ForceState::by_hand && !forces.node.empty();
        if (has_button) {
            // On the line of the text, so that the note covers only the messages in a small window, too.
            ImGui::PushID(forces.device.c_str());
            if (ImGui::Button("Let forces return")) bench.running()->recover(forces.node);
            mark_spot("Let forces return");
            ImGui::PopID();
            ImGui::SameLine();
            ImGui::AlignTextToFramePadding();
        }
        std::string text = forces.text(has_button);
        if (status->forces.size() > 1) text = fmt::format("{}: {}", forces.device, text);
        ImGui::PushStyleColor(ImGuiCol_Text, control::is_off(forces.state) ? tone::bad : tone::warm);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    set_spot("state of forces", {at.x, at.y, at.x + size.x, at.y + size.y});
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

}  // namespace tactus::window
