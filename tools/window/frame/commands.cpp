// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/commands.hpp"

#include "tools/window/frame/search.hpp"

#include <algorithm>
#include <utility>

namespace tactus::window {

Chord chord_of(std::string_view keys) {
    Chord chord;
    for (;;) {
        const std::size_t plus = keys.find('+');
        // "Ctrl++" has the key "+".
        if (plus == std::string_view::npos || plus + 1 >= keys.size()) break;
        const std::string_view part = keys.substr(0, plus);
        if (part == "Ctrl") chord.ctrl = true;
        else if (part == "Shift") chord.shift = true;
        else if (part == "Alt") chord.alt = true;
        keys.remove_prefix(plus + 1);
    }
    chord.key = keys;
    return chord;
}

bool passes_text_field(const Chord& chord) {
    if (chord.alt) return false;
    const std::string& key = chord.key;
    if (key.size() > 1 && key[0] == 'F' && key[1] >= '0' && key[1] <= '9') return true;
    // A field itself uses Ctrl with A, C, V, X, Y and Z.
    constexpr std::string_view letters = "SONPQ";
    return chord.ctrl && key.size() == 1 && letters.find(key[0]) != std::string_view::npos;
}

std::vector<const Command*> find_commands(const std::vector<Command>& all, std::string_view words) {
    std::vector<std::pair<double, const Command*>> found;
    for (const Command& command : all) {
        const double suit = suits(words, command.name, command.menu + " " + command.about);
        if (suit > 0.0) found.emplace_back(command.is_possible() ? suit : suit - 100.0, &command);
    }
    std::ranges::stable_sort(found, std::greater{}, &std::pair<double, const Command*>::first);
    std::vector<const Command*> commands;
    for (const auto& [suit, command] : found) commands.push_back(command);
    return commands;
}

}  // namespace tactus::window
