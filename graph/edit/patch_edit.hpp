// SPDX-License-Identifier: Apache-2.0
// Edits of a patch as edits of its text: what an edit does not name keeps its bytes, and with them comments, order and
// layout.
// Each takes a text that reads as a patch and returns the new one; whether that compiles is for PatchEditor to ask.
// All throw Error when what they name is not there.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::edit {

/// A wire as it is written: "blade.load", "saw.load", "linear".
struct WireText {
    std::string from, to;
    std::string mode;  ///< empty: none is written
};

struct NewNode {
    std::string name, type;
    std::string rate, group;  ///< one of them; none for a sub-patch whose nodes have rates
    std::vector<std::pair<std::string, std::string>> settings;  ///< parameters as people write them: "0.8 N/mm"
    std::vector<WireText> wires;
};

/// Sets a parameter, "0.8 N/mm", where it stands or as a new line of the node's table.
std::string with_setting(std::string_view text, std::string_view node, std::string_view name, std::string_view value);
/// Removes the parameter's line: its default holds.
std::string without_setting(std::string_view text, std::string_view node, std::string_view name);
/// Adds a table behind the last node's, and its wires.
std::string with_node(std::string_view text, const NewNode& node);
/// Removes a node and every wire that begins or ends there.
std::string without_node(std::string_view text, std::string_view name);
std::string with_node_named(std::string_view text, std::string_view from, std::string_view to);
/// Moves a node to a group of the patch, or to a rate such as "1 kHz".
std::string with_lane(std::string_view text, std::string_view node, std::string_view lane, bool is_group);
/// How many wires an input takes: events come from any number of outputs.
enum class InputTakes { one_wire, many_wires };
/// Adds a wire; it replaces one that feeds the same input, or one of the same two ends where the input takes many.
std::string with_wire(std::string_view text, const WireText& wire, InputTakes takes = InputTakes::one_wire);
/// Removes the wire to that input, "saw.load"; where `from` is given, the one from there.
std::string without_wire(std::string_view text, std::string_view to, std::string_view from = {});

}  // namespace tactus::edit
