// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/popup_keys.hpp"

#include <imgui.h>

namespace tactus::window {

void use_keys_in_popups() {
    ImGuiIO& io = ImGui::GetIO();
    const bool wanted = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup) && !io.WantTextInput;
    if (!wanted) {
        io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
        return;
    }
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    // Dear ImGui itself knows only Space.
    for (const ImGuiKey key : {ImGuiKey_Enter, ImGuiKey_KeyPadEnter})
        if (const int code = ImGui::GetKeyIndex(key); code >= 0 && io.KeysDown[code])
            io.NavInputs[ImGuiNavInput_Activate] = 1.0f;
}

}  // namespace tactus::window
