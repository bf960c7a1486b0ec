// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/hand_offer.hpp"

#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace tactus::window {

namespace {

constexpr const char *takes = "Take the hand", *gives = "Give the hand back";

}  // namespace

void draw_hand_offer(Workbench& bench) {
    const bool is_taken = bench.has_taken_hand();
    if (!is_taken && !bench.can_take_hand()) return;
    const char* const label = is_taken ? gives : takes;
    const float end = ImGui::GetItemRectMax().x + 2.0f * ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(label).x;
    if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    if (ImGui::SmallButton(label)) bench.want_hand(!is_taken);
    mark_spot(label);
    if (!ImGui::IsItemHovered()) return;
    const std::string text =
        is_taken ? "the device of the patch moves the hand again; the run begins again"
                 : fmt::format("mouse and keys move the hand in place of the driver '{}'; the run begins again",
                               hand_of(*bench.plan())->driver);
    show_tooltip(text);
}

void add_hand_commands(Workbench& bench, std::vector<Command>& all) {
    if (bench.can_take_hand())
        all.push_back({"run", takes, "", "mouse keys device trainee move", [&bench] { bench.want_hand(true); }});
    if (bench.has_taken_hand())
        all.push_back({"run", gives, "", "mouse device driver script", [&bench] { bench.want_hand(false); }});
}

}  // namespace tactus::window
