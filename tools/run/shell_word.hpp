// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::run {

/// One word for a POSIX shell, quoted.
inline std::string shell_word(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

/// The same without quotes where none are needed: for commands that people read.
inline std::string short_shell_word(const std::string& text) {
    constexpr const char* special = " \t\n\r'\"\\$`*?[](){}<>|&;#~!";
    return !text.empty() && text.find_first_of(special) == std::string::npos ? text : shell_word(text);
}

}  // namespace tactus::run
