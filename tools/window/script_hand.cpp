// SPDX-License-Identifier: Apache-2.0
// Mouse and keyboard of a script.
#include "tools/window/desk/desk.hpp"
#include "tools/window/script.hpp"
#include "tools/window/widgets/spots.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>

namespace tactus::window {

Script::Keys Script::key_named(const std::string& name) {
    Keys keys;
    keys.is_active = true;
    std::string key = name;
    if (key.starts_with("ctrl+")) {
        keys.ctrl = true;
        key.erase(0, 5);
    }
    if (key == "enter") keys.key = ImGui::GetKeyIndex(ImGuiKey_Enter);
    else if (key == "delete") keys.key = ImGui::GetKeyIndex(ImGuiKey_Delete);
    else if (key == "tab") keys.key = ImGui::GetKeyIndex(ImGuiKey_Tab);
    else if (key == "escape") keys.key = ImGui::GetKeyIndex(ImGuiKey_Escape);
    else if (key == "down") keys.key = ImGui::GetKeyIndex(ImGuiKey_DownArrow);
    else if (key == "up") keys.key = ImGui::GetKeyIndex(ImGuiKey_UpArrow);
    else if (key == "f1") keys.key = 290;  // of GLFW
    else if (key == "space") keys.key = ImGui::GetKeyIndex(ImGuiKey_Space);
    else if (key.size() == 1) keys.key = std::toupper(static_cast<unsigned char>(key[0]));
    else throw Error(fmt::format("no key '{}'", name));
    return keys;
}

namespace {

/// Letters, then keys: pressed in one frame, released in the next.
void press_keys(const Script::Keys& keys) {
    ImGuiIO& io = ImGui::GetIO();
    if (!keys.text.empty()) io.AddInputCharactersUTF8(keys.text.c_str());
    if (!keys.is_active) return;
    io.KeyCtrl = keys.ctrl;
    if (keys.key >= 0) io.KeysDown[keys.key] = keys.is_down;
}

}  // namespace

void Script::move_mouse() const {
    press_keys(keys_);
    if (!mouse_) return;
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = ImVec2(static_cast<float>(mouse_->at.x), static_cast<float>(mouse_->at.y));
    io.MouseDown[0] = mouse_->left;
    io.MouseDown[1] = mouse_->right;
    io.MouseWheel = static_cast<float>(mouse_->wheel);
    // A slow machine takes longer between two presses.
    io.MouseDoubleClickTime = 5.0f;
}

namespace {

/// The position of "record", "saw.load" or "blade".
Point place(const std::string& name, const Desk& desk) {
    if (const auto box = spot(name)) return box->middle();
    if (const auto at = desk.patch().place_of(name)) return *at;
    throw Error(fmt::format("'{}' is not visible", name));
}

}  // namespace

/// Press, double press, slide and pull at the speed of a hand, because the item under the mouse is known one frame
/// later.
bool Script::use_hand(const ScriptLine& line, Desk& desk) {
    constexpr int looks = 3, presses = 5, arrives = 12, lets_go = 14, done_at = 17;
    const std::string& what = line.words.front();
    if (pictures_ < looks) {
        mouse_ = Mouse{};
        return false;
    }
    if (pictures_ == looks) {
        from_ = to_ = place(line.word(1), desk);
        if (what == "slide") {
            const auto box = spot(line.word(1));
            to_.x = box ? box->left + line.number(2) * box->width() : from_.x;
        }
        if (what == "pull") to_ = place(line.word(2), desk);
    }
    const double way = std::clamp((pictures_ - presses) / static_cast<double>(arrives - presses), 0.0, 1.0);
    bool down = pictures_ >= presses && pictures_ < (what == "press" ? presses + 3 : lets_go);
    if (what == "double") down = pictures_ == presses || pictures_ == presses + 2;
    mouse_ = Mouse{from_ + (to_ - from_) * way, down, false, 0.0};
    return pictures_ >= done_at;
}

}  // namespace tactus::window
