// SPDX-License-Identifier: Apache-2.0
// Functions that find the lines of a text from a byte offset.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace tactus::patch {

/// Returns the offset of the first byte of the line.
inline std::size_t line_start(std::string_view text, std::size_t at) {
    return at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is the start of the text
}

/// Returns the offset after the newline of the line, or the end of the text.
inline std::size_t line_end(std::string_view text, std::size_t at) {
    const std::size_t newline = text.find('\n', at);
    return newline == std::string_view::npos ? text.size() : newline + 1;
}

/// Returns true for text of spaces, tabs and newlines only.
inline bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

inline bool is_empty_line(std::string_view text, std::size_t start) {
    return is_blank(text.substr(start, line_end(text, start) - start));
}

/// Returns the spaces and tabs at the start of the line.
inline std::string indent_of(std::string_view text, std::size_t at) {
    const std::size_t start = line_start(text, at);
    const std::size_t end = std::min(text.find_first_not_of(" \t", start), text.size());
    return std::string(text.substr(start, end - start));
}

/// Returns "\r\n" if the first line of the text ends so, otherwise "\n".
inline std::string_view newline_of(std::string_view text) {
    const std::size_t newline = text.find('\n');
    return newline != std::string_view::npos && newline > 0 && text[newline - 1] == '\r' ? "\r\n" : "\n";
}

}  // namespace tactus::patch
