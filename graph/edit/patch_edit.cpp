// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_edit.hpp"

#include "dsp/core/error.hpp"
#include "graph/edit/patch_editing.hpp"
#include "graph/patch/patch_wire.hpp"
#include "graph/patch/sub_patch.hpp"
#include "graph/patch/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

namespace tactus::edit {

namespace {

/// The wires of a patch, as they are written.
struct WrittenWire {
    TomlElement element;
    std::string text;
    std::optional<patch::PatchWire> wire;
};

std::vector<WrittenWire> wires_of(const Editing& editing) {
    std::vector<WrittenWire> wires;
    const TomlEntry* list = editing.spans().find({"wires"});
    if (!list || !list->value.of(editing.text()).starts_with('[')) return wires;
    for (const TomlElement& element : toml_elements(editing.text(), list->value)) {
        WrittenWire& written = wires.emplace_back(WrittenWire{element, {}, {}});
        written.text = toml_unquoted(element.value.of(editing.text()));
        try {
            written.wire = patch::parse_wire(written.text, {}, false);
        } catch (const Error&) {
            // What is no wire is left as it is.
        }
    }
    return wires;
}

std::string joined(const WireText& wire, std::size_t arrow_column) {
    const std::size_t width = std::max(arrow_column, wire.from.size() + 1);
    return fmt::format("{:<{}}-> {}{}{}", wire.from, width, wire.to, wire.mode.empty() ? "" : " as ", wire.mode);
}

std::size_t arrow_column(const std::string& wire) {
    const std::size_t arrow = wire.find("->");
    return arrow == std::string::npos ? 0 : arrow;
}

void remove_element(Editing& editing, const TomlElement& element) {
    const std::string_view text = editing.text();
    const bool has_comma = element.comma.end > 0;
    const std::size_t end = has_comma ? element.comma.end : element.value.end;
    const std::size_t from = patch::line_start(text, element.value.begin), to = patch::line_end(text, end);
    const bool one_line = to == patch::line_end(text, element.value.end);
    const bool alone = one_line && patch::is_blank(text.substr(from, element.value.begin - from)) &&
                       (patch::is_blank(text.substr(end, to - end)) ||
                        text.substr(std::min(text.find_first_not_of(" \t", end), text.size())).starts_with('#'));
    if (alone) return editing.replace({from, to}, "");
    if (!one_line) {
        editing.replace(element.comma, "");
        return editing.replace(element.value, "");
    }
    std::size_t behind = end;
    while (has_comma && behind < text.size() && (text[behind] == ' ' || text[behind] == '\t')) ++behind;
    editing.replace({element.value.begin, behind}, "");
}

void add_element(Editing& editing, const WireText& wire) {
    const std::string_view text = editing.text();
    const std::string newline(patch::newline_of(text));
    const TomlEntry* list = editing.spans().find({"wires"});
    if (!list) {
        const std::string lines = fmt::format("wires = [{0}  {1},{0}]{0}", newline, toml_quoted(joined(wire, 0)));
        std::size_t at = editing.spans().headers.empty()
                             ? text.size()
                             : patch::line_start(text, editing.spans().headers.front().span.begin);
        for (const TomlEntry& entry : editing.spans().entries)
            if (entry.header < 0) at = patch::line_end(text, entry.span.end);
        const bool ends_line = at == 0 || text[at - 1] == '\n';
        return editing.replace({at, at}, (ends_line ? "" : newline) + lines);
    }
    const std::vector<WrittenWire> wires = wires_of(editing);
    const std::size_t bracket = list->value.end - 1;
    if (wires.empty()) {
        const std::string made = toml_quoted(joined(wire, 0));
        const std::size_t start = patch::line_start(text, bracket);
        if (start > list->value.begin) return editing.replace({start, start}, "  " + made + "," + newline);
        return editing.replace({bracket, bracket}, made);
    }
    const TomlElement& last = wires.back().element;
    const bool has_comma = last.comma.end > 0;
    const std::size_t end = has_comma ? last.comma.end : last.value.end;
    const std::string made = toml_quoted(joined(wire, arrow_column(wires.back().text)));
    const std::size_t behind = patch::line_end(text, end);
    const bool has_own_line = patch::is_blank(text.substr(
        patch::line_start(text, last.value.begin), last.value.begin - patch::line_start(text, last.value.begin)));
    if (!has_own_line || bracket < behind) return editing.replace({end, end}, (has_comma ? " " : ", ") + made);
    const std::string line = patch::indent_of(text, last.value.begin) + made + (has_comma ? "," : "") + newline;
    editing.replace({behind, behind}, line);
    if (!has_comma) editing.replace({end, end}, ",");
}

/// The text of a wire, with one node renamed.
std::string renamed(const std::string& wire, const patch::PatchWire& read, std::string_view from, std::string_view to) {
    std::string text = wire;
    const auto rename_at = [&](std::size_t at) {
        at = text.find_first_not_of(" \t\r\n", at);
        text.replace(at, from.size(), to);
    };
    if (read.to_node == from) rename_at(text.find("->") + 2);
    if (read.from_node == from && !read.from_port.empty()) rename_at(0);
    return text;
}

std::string end_of(const patch::PatchWire& wire) { return wire.to_node + "." + wire.to_port; }
/// An asset has no port.
std::string start_of(const patch::PatchWire& wire) {
    return wire.from_port.empty() ? wire.from_node : wire.from_node + "." + wire.from_port;
}

/// Nodes within a sub-patch are not part of this text.
void refuse_within(std::string_view name) {
    const std::size_t end = name.find(patch::within_node);
    if (end == std::string_view::npos) return;
    throw Error(fmt::format("'{}' is within '{}': edit the file of that patch, or set what it offers", name,
                            name.substr(0, end)));
}

}  // namespace

std::string with_setting(std::string_view text, std::string_view node, std::string_view name, std::string_view value) {
    refuse_within(node);
    Editing editing(text);
    editing.set({"nodes", std::string(node)}, name, value);
    return editing.result();
}

std::string without_setting(std::string_view text, std::string_view node, std::string_view name) {
    refuse_within(node);
    Editing editing(text);
    editing.reset({"nodes", std::string(node)}, name);
    return editing.result();
}

std::string with_node(std::string_view text, const NewNode& node) {
    for (const WireText& wire : node.wires) refuse_within(wire.from), refuse_within(wire.to);
    Editing editing(text);
    editing.add_table(node);
    for (const WireText& wire : node.wires) add_element(editing, wire);
    return editing.result();
}

std::string without_node(std::string_view text, std::string_view name) {
    refuse_within(name);
    Editing editing(text);
    editing.remove_node(name);
    for (bool found = true; found;) {
        found = false;
        for (const WrittenWire& written : wires_of(editing)) {
            const bool ends_there =
                written.wire && (written.wire->to_node == name ||
                                 (written.wire->from_node == name && !written.wire->from_port.empty()));
            if (!ends_there) continue;
            remove_element(editing, written.element);
            found = true;
            break;
        }
    }
    return editing.result();
}

std::string with_node_named(std::string_view text, std::string_view from, std::string_view to) {
    refuse_within(from);
    Editing editing(text);
    editing.rename(from, to);
    std::vector<WrittenWire> wires = wires_of(editing);
    for (auto written = wires.rbegin(); written != wires.rend(); ++written) {
        if (!written->wire) continue;
        const std::string made = renamed(written->text, *written->wire, from, to);
        if (made == written->text) continue;
        const std::string_view before = written->element.value.of(editing.text());
        const bool is_literal = before.starts_with('\'') && !before.starts_with("'''");
        editing.replace(written->element.value, is_literal ? "'" + made + "'" : toml_quoted(made));
    }
    return editing.result();
}

std::string with_lane(std::string_view text, std::string_view node, std::string_view lane, bool is_group) {
    refuse_within(node);
    Editing editing(text);
    editing.move_to_lane(node, lane, is_group);
    return editing.result();
}

std::string with_wire(std::string_view text, const WireText& wire, InputTakes takes) {
    refuse_within(wire.from);
    refuse_within(wire.to);
    Editing editing(text);
    for (const WrittenWire& written : wires_of(editing)) {
        if (!written.wire || end_of(*written.wire) != wire.to) continue;
        if (takes == InputTakes::many_wires && start_of(*written.wire) != wire.from) continue;
        editing.replace(written.element.value, toml_quoted(joined(wire, arrow_column(written.text))));
        return editing.result();
    }
    add_element(editing, wire);
    return editing.result();
}

std::string without_wire(std::string_view text, std::string_view to, std::string_view from) {
    refuse_within(to);
    Editing editing(text);
    for (const WrittenWire& written : wires_of(editing)) {
        if (!written.wire || end_of(*written.wire) != to) continue;
        if (!from.empty() && start_of(*written.wire) != from) continue;
        remove_element(editing, written.element);
        return editing.result();
    }
    if (!from.empty()) throw Error(fmt::format("no wire leads from '{}' to '{}'", from, to));
    throw Error(fmt::format("no wire leads to '{}'", to));
}

namespace {

/// Bounds of a line without its end; npos, npos: there is none.
std::pair<std::size_t, std::size_t> bounds_of(std::string_view text, int line) {
    constexpr std::size_t none = std::string_view::npos;
    std::size_t begin = line < 1 ? none : 0;
    for (int at = 1; at < line && begin != none; ++at)
        if (begin = text.find('\n', begin); begin != none) ++begin;
    if (begin == none || (begin == text.size() && begin > 0)) return {none, none};
    std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin && text[end - 1] == '\r') --end;
    return {begin, end};
}

}  // namespace

std::string line_of(std::string_view text, int line) {
    const auto [begin, end] = bounds_of(text, line);
    return begin == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin));
}

std::string with_line(std::string_view text, int line, const std::optional<std::string>& by) {
    const auto [begin, end] = bounds_of(text, line);
    if (begin == std::string_view::npos) throw Error(fmt::format("the patch has no line {}", line));
    const std::size_t next = std::min(text.find('\n', end), text.size() - 1) + 1;
    return std::string(text.substr(0, begin)) + by.value_or("") + std::string(text.substr(by ? end : next));
}

std::size_t find_word(std::string_view line, std::string_view word) {
    const auto is_letter = [&](std::size_t at) {
        return at < line.size() && (std::isalnum(static_cast<unsigned char>(line[at])) || line[at] == '_');
    };
    for (std::size_t at = 0; (at = line.find(word, at)) != std::string_view::npos; ++at)
        if (!word.empty() && !(at > 0 && is_letter(at - 1)) && !is_letter(at + word.size())) return at;
    return std::string_view::npos;
}

}  // namespace tactus::edit
