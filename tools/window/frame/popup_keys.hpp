// SPDX-License-Identifier: Apache-2.0
// Menus and questions by keyboard.
#pragma once

namespace tactus::window {

/// Arrows go from item to item of an open menu or question, which shows a frame around the one that Enter or Space presses.
/// Elsewhere, and in fields, these keys have work of their own. Once per picture, before ImGui::NewFrame.
void use_keys_in_popups();

}  // namespace tactus::window
