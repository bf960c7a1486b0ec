// SPDX-License-Identifier: Apache-2.0
#include "assets/file/toml_depth.hpp"

#include <algorithm>
#include <cctype>

namespace tactus::file {

namespace {

/// Offset after the string that starts at `at`. An unterminated string ends with its line, or with the text if it may
/// span lines; the parser reports it.
std::size_t end_of_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string_view fence = quote == '"' ? "\"\"\"" : "'''";
    const bool spans_lines = text.substr(at).starts_with(fence);
    for (std::size_t i = at + (spans_lines ? 3 : 1); i < text.size(); ++i) {
        if (quote == '"' && text[i] == '\\') ++i;
        else if (spans_lines && text.substr(i).starts_with(fence)) return i + 3;
        else if (!spans_lines && (text[i] == quote || text[i] == '\n')) return i + 1;
    }
    return text.size();
}

}  // namespace

std::optional<std::size_t> overlong_key(std::string_view toml) {
    int dots = 0;
    for (std::size_t at = 0; at < toml.size();) {
        const char c = toml[at];
        if (c == '"' || c == '\'') {
            at = end_of_string(toml, at);
            continue;
        }
        if (c == '#') {
            at = std::min(toml.find('\n', at), toml.size());
            continue;
        }
        if (c == '.') {
            if (++dots > max_dots_in_key) return at;
        } else if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != ' ' && c != '\t') {
            dots = 0;
        }
        ++at;
    }
    return std::nullopt;
}

}  // namespace tactus::file
