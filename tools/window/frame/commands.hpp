// SPDX-License-Identifier: Apache-2.0
// What can be done in the window, by name: for menus, keys and the list that Ctrl+P opens. No user interface.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::window {

struct Command {
    std::string menu;   ///< "File"; empty: in no menu
    std::string name;   ///< "Save as..."
    std::string keys;   ///< "Ctrl+Shift+S"; empty: none
    std::string about;  ///< more words that find it
    std::function<void()> run;
    std::function<bool()> may = nullptr;    ///< null: always
    std::function<bool()> is_on = nullptr;  ///< for a switch; null: none
    bool is_separated = false;  ///< a line above it in the menu

    bool is_possible() const { return !may || may(); }
};

/// A key with its modifiers.
struct Chord {
    bool ctrl = false, shift = false, alt = false;
    std::string key;  ///< "S", "F1", "Tab", "Del", "Space"
    bool operator==(const Chord&) const = default;
};
/// Of "Ctrl+Shift+S".
Chord chord_of(std::string_view keys);

/// A chord that means nothing in a text field, so that it works also while one types: Ctrl+S, F5.
bool passes_text_field(const Chord& chord);

/// Those that suit some words, best first; those that are not possible now come last.
std::vector<const Command*> find_commands(const std::vector<Command>& all, std::string_view words);

}  // namespace tactus::window
