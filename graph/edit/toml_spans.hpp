// SPDX-License-Identifier: Apache-2.0
// The byte ranges of the parts of a TOML text, for edits that leave the rest of the text unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::edit {

/// Bytes begin … end − 1 of a text.
struct TextSpan {
    std::size_t begin = 0, end = 0;

    std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
    bool operator==(const TextSpan&) const = default;
};

/// "[nodes.hand]"
struct TomlHeader {
    std::vector<std::string> path;
    std::vector<TextSpan> keys;  ///< one for each part of the path
    TextSpan span;               ///< with its brackets
};

/// "rate = "1 kHz"", in a table or between the braces of an inline one.
struct TomlEntry {
    std::vector<std::string> path;  ///< from the root; dotted keys are split
    std::vector<TextSpan> keys;     ///< the last parts of the path, which are written in this entry
    TextSpan span, value;           ///< `span`: from the key to the end of the value
    int header = -1;                ///< the header above it, −1: none
    int parent = -1;                ///< the entry whose inline table contains it, −1: none

    /// The range of part `i` of the path; null if this header does not contain it.
    const TextSpan* key(std::size_t i) const {
        const std::size_t above = path.size() - keys.size();
        return i < above || i >= path.size() ? nullptr : &keys[i - above];
    }
};

struct TomlSpans {
    std::vector<TomlHeader> headers;
    std::vector<TomlEntry> entries;  ///< in the order of the text

    const TomlEntry* find(const std::vector<std::string>& path) const;
};

/// Finds the parts of a text. In a text that a TOML parser would reject, it returns the parts that it recognises.
TomlSpans toml_spans(std::string_view text);

/// One element of an array: its value and the comma after it (empty: none).
struct TomlElement {
    TextSpan value, comma;
};
std::vector<TomlElement> toml_elements(std::string_view text, const TextSpan& array);

/// The content of a string in quotes, or the text itself when it has no quotes.
std::string toml_unquoted(std::string_view written);
/// `text` as a one-line string in quotes.
std::string toml_quoted(std::string_view text);

}  // namespace tactus::edit
