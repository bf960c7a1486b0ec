// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/whole_window.hpp"

#include "tools/window/frame/popup_keys.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

#include <algorithm>

namespace tactus::window {

void begin_whole_window(const char* name, const Fonts& fonts) {
    forget_spots();
    use_keys_in_popups();
    // A double click takes four pictures, and slow ones must not make two single clicks of it.
    ImGuiIO& io = ImGui::GetIO();
    io.MouseDoubleClickTime = std::clamp(6.0f * io.DeltaTime, 0.3f, 2.0f);
    ImGui::NewFrame();
    ImGui::PushFont(fonts.body);
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize(viewport->Size);
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
}

}  // namespace tactus::window
