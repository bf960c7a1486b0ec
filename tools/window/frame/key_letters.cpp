// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/key_letters.hpp"

#include <string_view>

namespace tactus::window {

namespace {

int code_of(int key, const char* name) {
    const std::string_view said = name ? name : "";
    if (!KeyLetters::is_printable(key) || said.size() != 1) return key;
    const char c = said.front();
    if (c >= 'a' && c <= 'z') return c - 'a' + 'A';
    if (c >= 'A' && c <= 'Z') return c;
    // Digits stay where they are, also where they need Shift; a letter's place with a comma on it is no letter.
    const bool is_place_of_letter = key >= 'A' && key <= 'Z';
    return is_place_of_letter && c > ' ' && c < '\x7f' ? c : key;
}

}  // namespace

int KeyLetters::code(int key, int scancode, const char* name, bool is_down) {
    const auto pressed = down_.find(scancode);
    if (!is_down && pressed != down_.end()) {
        const int code = pressed->second;
        down_.erase(pressed);
        return code;
    }
    const int code = code_of(key, name);
    if (is_down) down_[scancode] = code;
    return code;
}

}  // namespace tactus::window
