// SPDX-License-Identifier: Apache-2.0
#include "tools/view/frame/commands.hpp"

#include "tools/view/frame/search.hpp"

#include <algorithm>
#include <utility>

namespace tactus::view {

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

}  // namespace tactus::view
