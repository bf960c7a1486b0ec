// SPDX-License-Identifier: Apache-2.0
// Edits of a patch as edits of its text: bytes that an edit does not name stay unchanged, so comments, order and layout
// are kept. Each function expects a text that reads as a patch and returns the new text. They do not check that the
// result compiles; PatchEditor does. All throw Error if the named item does not exist.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::edit {

/// A wire as written: "blade.load", "saw.load", "linear".
struct WireText {
    std::string from, to;
    std::string mode;  ///< empty: none is written
};

struct NewNode {
    std::string name, type;
    std::string rate, group;  ///< exactly one is set; neither for a sub-patch whose nodes have rates
    std::vector<std::pair<std::string, std::string>> settings;  ///< parameters with their texts: "0.8 N/mm"
    std::vector<WireText> wires;
};

/// Sets a parameter, such as "0.8 N/mm", in its line or in a new line of the node's table.
std::string with_setting(std::string_view text, std::string_view node, std::string_view name, std::string_view value);
/// Removes the parameter's line, which restores its default.
std::string without_setting(std::string_view text, std::string_view node, std::string_view name);
/// Adds a table after that of the last node, and the node's wires.
std::string with_node(std::string_view text, const NewNode& node);
/// Removes a node and every wire that begins or ends there.
std::string without_node(std::string_view text, std::string_view name);
std::string with_node_named(std::string_view text, std::string_view from, std::string_view to);
/// Moves a node to a group of the patch, or to a rate such as "1 kHz".
std::string with_lane(std::string_view text, std::string_view node, std::string_view lane, bool is_group);
/// Number of wires that an input accepts: one, or for events any number.
enum class InputTakes { one_wire, many_wires };
/// Adds a wire. It replaces the wire to the same input or, for an input that accepts many, the wire between the same
/// ends.
std::string with_wire(std::string_view text, const WireText& wire, InputTakes takes = InputTakes::one_wire);
/// Removes the wire to an input such as "saw.load"; if `from` is given, only the wire from there.
std::string without_wire(std::string_view text, std::string_view to, std::string_view from = {});

/// A line of the text without its end, counted from 1; empty: there is none.
std::string line_of(std::string_view text, int line);
/// Replaces a line, or removes it if `by` is empty. The text need not read as a patch: this is how it is repaired.
std::string with_line(std::string_view text, int line, const std::optional<std::string>& by);
/// Offset of a name in a line that is not part of a longer one; npos: it is not there.
std::size_t find_word(std::string_view line, std::string_view word);

}  // namespace tactus::edit
