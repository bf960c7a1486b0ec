// SPDX-License-Identifier: Apache-2.0
// Finds letters that a border cuts although nothing scrolls there: text that has no room.
#pragma once

#include <filesystem>

namespace tactus::window {

/// Writes a list of them from the frame that is being drawn, see `write_cut_letters`.
void want_cut_letters(const std::filesystem::path& file);
/// After ImGui::Render: if it is wanted, writes one line per place, "PANEL<tab>LETTERS<tab>x<tab>y". Letters that the user
/// can scroll into view are not in the list, along the axis in which their panel or one around it scrolls. Throws Error.
void write_cut_letters();

}  // namespace tactus::window
