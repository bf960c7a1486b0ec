// SPDX-License-Identifier: Apache-2.0
// The view, moved by mouse and keys.
#include "tools/window/scene/scene_panel.hpp"

#include <cmath>
#include <numbers>

namespace tactus::window {

void ScenePanel::steer(Point corner, int width, int height) {
    const bool is_hand = hand_.steer(camera, height);
    steer_by_keys(ImGui::IsItemHovered() || ImGui::IsItemActive());
    const bool is_fragment = !is_hand && steer_fragment(corner, height);
    if (is_hand || is_fragment || (!ImGui::IsItemHovered() && !ImGui::IsItemActive())) return;
    const ImGuiIO& io = ImGui::GetIO();
    const Point by = point(io.MouseDelta);
    const display::OrbitCamera before = camera;
    if (hand_.has_mouse() && ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 2.0f))
        camera.orbit(-by.x * 2.0 * std::numbers::pi / width, by.y * std::numbers::pi / height);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f) && !io.KeyShift)
        camera.orbit(-by.x * 2.0 * std::numbers::pi / width, by.y * std::numbers::pi / height);
    else if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 2.0f) ||
             ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2.0f))
        camera.pan(by.x / height, -by.y / height);
    if (io.MouseWheel != 0.0f) camera.zoom(std::pow(1.15, static_cast<double>(io.MouseWheel)));
    // Who moves the view before all of the scene has come has aimed it.
    if (camera.distance != before.distance || camera.target != before.target)
        is_aimed_ = is_aimed_ || !model_->bounds().empty();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

/// Sides and turns wherever the pointer is, for those who have none. `is_pointed_at`: letters that other panels have, too.
void ScenePanel::steer_by_keys(bool is_pointed_at) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || io.KeyCtrl || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return;
    const display::OrbitCamera before = camera;
    for (int key = 1; key <= 7; ++key)
        if (ImGui::IsKeyPressed('0' + key, false)) look_from(*display::view_of_number(key));
    if (is_pointed_at && ImGui::IsKeyPressed('F', false)) fit();
    if (is_pointed_at && ImGui::IsKeyPressed('R', false)) reset();
    constexpr double turn_rad = 0.1, nearer = 1.15;
    const auto pressed = [&](ImGuiKey key) { return io.KeyAlt && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    if (pressed(ImGuiKey_LeftArrow)) camera.orbit(-turn_rad, 0.0);
    if (pressed(ImGuiKey_RightArrow)) camera.orbit(turn_rad, 0.0);
    if (pressed(ImGuiKey_UpArrow)) camera.orbit(0.0, turn_rad);
    if (pressed(ImGuiKey_DownArrow)) camera.orbit(0.0, -turn_rad);
    if (pressed(ImGuiKey_PageUp)) camera.zoom(nearer);
    if (pressed(ImGuiKey_PageDown)) camera.zoom(1.0 / nearer);
    if (camera.distance != before.distance) is_aimed_ = is_aimed_ || !model_->bounds().empty();
    needs_picture_ = needs_picture_ || before.eye() != camera.eye() || before.target != camera.target;
}

}  // namespace tactus::window
