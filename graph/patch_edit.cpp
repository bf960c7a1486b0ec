// SPDX-License-Identifier: Apache-2.0
#include "graph/patch_edit.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch_wire.hpp"
#include "graph/text_lines.hpp"
#include "graph/toml_spans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cctype>
#include <optional>

namespace tactus {

namespace {

using Path = std::vector<std::string>;

bool starts_with(const Path& path, const Path& with) {
    return path.size() >= with.size() && std::equal(with.begin(), with.end(), path.begin());
}

/// Numbers and truth values stand without quotes.
bool is_bare(std::string_view value) {
    if (value == "true" || value == "false") return true;
    const std::string_view digits = value.starts_with('-') ? value.substr(1) : value;
    if (digits.empty() || !std::isdigit(static_cast<unsigned char>(digits.front()))) return false;
    if (digits.size() > 1 && digits[0] == '0' && digits[1] != '.') return false;
    if (!std::isdigit(static_cast<unsigned char>(value.back()))) return false;
    double number = 0.0;
    const auto [end, failure] = std::from_chars(value.data(), value.data() + value.size(), number);
    return failure == std::errc{} && end == value.data() + value.size();
}

std::string literal(std::string_view value) { return is_bare(value) ? std::string(value) : toml_quoted(value); }

/// As what stood there before: in quotes, as a list of quantities, or bare.
std::string literal_like(std::string_view before, std::string_view value) {
    if (before.starts_with('"') || before.starts_with('\'')) return toml_quoted(value);
    if (!before.starts_with('[')) return literal(value);
    std::string list = "[";
    for (std::size_t at = 0; at <= value.size();) {
        const std::size_t end = std::min(value.find(',', at), value.size());
        std::string_view part = value.substr(at, end - at);
        while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
        list += (list.size() > 1 ? ", " : "") + literal(part);
        at = end + 1;
    }
    return list + "]";
}

/// "key = value" in the layout of the entry above it.
std::string entry_like(std::string_view text, const TomlEntry& above, std::string_view key, std::string_view value) {
    const std::size_t key_begin = above.keys.back().begin, equals = text.find('=', above.keys.back().end);
    const std::string before(text.substr(above.span.begin, key_begin - above.span.begin));
    const std::string behind(text.substr(equals + 1, above.value.begin - equals - 1));
    const std::size_t width = std::max(equals - key_begin, key.size() + (equals > above.keys.back().end ? 1 : 0));
    return fmt::format("{}{:<{}}={}{}", before, key, width, behind, value);
}

/// An edit of one text, and what it looks like by now.
class Editing {
public:
    explicit Editing(std::string_view text) : text_(text), spans_(toml_spans(text_)) {}

    std::string result() { return std::move(text_); }

    void set(const Path& owner, std::string_view name, std::string_view value) {
        Path path = owner;
        path.emplace_back(name);
        if (const TomlEntry* entry = spans_.find(path))
            return replace(entry->value, literal_like(entry->value.of(text_), value));
        insert(owner, name, literal(value));
    }

    void reset(const Path& owner, std::string_view name) {
        Path path = owner;
        path.emplace_back(name);
        const TomlEntry* entry = spans_.find(path);
        if (!entry) throw Error(fmt::format("'{}.{}' is not set in the patch", owner.back(), name));
        remove(*entry);
    }

    void add_table(const NewNode& node) {
        if (!is_name(node.name))
            throw Error(fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", node.name));
        if (has({"nodes", node.name})) throw Error(fmt::format("there is a node '{}' already", node.name));
        std::vector<std::pair<std::string, std::string>> lines{{"type", toml_quoted(node.type)}};
        if (node.group.empty()) lines.emplace_back("rate", toml_quoted(node.rate));
        else lines.emplace_back("group", toml_quoted(node.group));
        for (const auto& [name, value] : node.settings) lines.emplace_back(name, literal(value));
        if (const TomlEntry* all = spans_.find({"nodes"}); all && all->value.of(text_).starts_with('{')) {
            std::string table = "{ ";
            for (const auto& [name, value] : lines)
                table += fmt::format("{}{} = {}", table.size() > 2 ? ", " : "", name, value);
            return insert({"nodes"}, node.name, table + " }");
        }
        std::size_t width = 0;
        for (const auto& line : lines) width = std::max(width, line.first.size());
        const std::string newline(newline_of(text_));
        std::string table = fmt::format("[nodes.{}]{}", node.name, newline);
        for (const auto& [name, value] : lines) table += fmt::format("{:<{}} = {}{}", name, width, value, newline);
        std::size_t at = text_.size();
        for (std::size_t h = 0; h < spans_.headers.size(); ++h)
            if (spans_.headers[h].path.front() == "nodes") at = line_end(text_, last_of(h));
        const bool ends_line = at == 0 || text_[at - 1] == '\n';
        replace({at, at}, (ends_line ? "" : newline) + (at == 0 ? "" : newline) + table);
    }

    void remove_node(std::string_view name) {
        const Path path{"nodes", std::string(name)};
        if (!has(path)) throw Error(fmt::format("no node '{}'", name));
        while (remove_one(path)) {
        }
    }

    void rename(std::string_view from, std::string_view to) {
        const Path path{"nodes", std::string(from)};
        if (!has(path)) throw Error(fmt::format("no node '{}'", from));
        if (!is_name(to)) throw Error(fmt::format("'{}' is no name; names have letters, digits, '_' and '-'", to));
        if (has({"nodes", std::string(to)})) throw Error(fmt::format("there is a node '{}' already", to));
        std::vector<TextSpan> places;
        for (const TomlHeader& header : spans_.headers)
            if (starts_with(header.path, path)) places.push_back(header.keys[1]);
        for (const TomlEntry& entry : spans_.entries)
            if (const TextSpan* key = entry.key(1); key && starts_with(entry.path, path)) places.push_back(*key);
        std::ranges::sort(places, std::greater{}, &TextSpan::begin);
        for (const TextSpan& place : places) text_.replace(place.begin, place.end - place.begin, to);
        spans_ = toml_spans(text_);
    }

    std::string_view text() const { return text_; }
    const TomlSpans& spans() const { return spans_; }

    void replace(const TextSpan& span, std::string_view by) {
        text_.replace(span.begin, span.end - span.begin, by);
        spans_ = toml_spans(text_);
    }

private:
    bool has(const Path& path) const {
        return std::ranges::any_of(spans_.headers, [&](const auto& h) { return starts_with(h.path, path); }) ||
               std::ranges::any_of(spans_.entries, [&](const auto& e) { return starts_with(e.path, path); });
    }

    /// End of the last thing that belongs to a header.
    std::size_t last_of(std::size_t header) const {
        std::size_t end = spans_.headers[header].span.end;
        for (const TomlEntry& entry : spans_.entries)
            if (entry.header == static_cast<int>(header)) end = std::max(end, entry.span.end);
        return end;
    }

    /// A new entry, as a line behind `at`.
    void insert_line(std::size_t at, const std::string& entry) {
        const std::size_t end = line_end(text_, at);
        const std::string newline(newline_of(text_));
        if (end > 0 && text_[end - 1] == '\n') replace({end, end}, entry + newline);
        else replace({end, end}, newline + entry);
    }

    void insert(const Path& owner, std::string_view name, const std::string& value) {
        for (std::size_t h = 0; h < spans_.headers.size(); ++h) {
            if (spans_.headers[h].path != owner) continue;
            const TomlEntry* last = nullptr;
            for (const TomlEntry& entry : spans_.entries)
                if (entry.header == static_cast<int>(h) && entry.parent < 0 && entry.keys.size() == 1) last = &entry;
            if (!last) return insert_line(spans_.headers[h].span.end, fmt::format("{} = {}", name, value));
            const std::string indent = indent_of(text_, last->span.begin);
            return insert_line(last->span.end, indent + entry_like(text_, *last, name, value));
        }
        if (const TomlEntry* table = spans_.find(owner); table && table->value.of(text_).starts_with('{')) {
            const int index = static_cast<int>(table - spans_.entries.data());
            const TomlEntry* last = nullptr;
            for (const TomlEntry& entry : spans_.entries)
                if (entry.parent == index) last = &entry;
            if (!last) return replace(table->value, fmt::format("{{ {} = {} }}", name, value));
            return replace({last->span.end, last->span.end}, fmt::format(", {} = {}", name, value));
        }
        const TomlEntry* last = nullptr;
        for (const TomlEntry& entry : spans_.entries)
            if (starts_with(entry.path, owner) && entry.path.size() == owner.size() + 1) last = &entry;
        if (!last) throw Error(fmt::format("no node '{}'", owner.back()));
        const std::string made = entry_like(text_, *last, name, value);
        if (last->parent >= 0) return replace({last->span.end, last->span.end}, ", " + made);
        insert_line(last->span.end, indent_of(text_, last->span.begin) + made);
    }

    /// With its line, or with a comma when it stands between braces.
    void remove(const TomlEntry& entry) {
        if (entry.parent < 0)
            return replace({line_start(text_, entry.span.begin), line_end(text_, entry.span.end)}, "");
        const TomlEntry *before = nullptr, *behind = nullptr;
        for (const TomlEntry& other : spans_.entries) {
            if (other.parent != entry.parent) continue;
            if (other.span.begin < entry.span.begin) before = &other;
            else if (other.span.begin > entry.span.begin && !behind) behind = &other;
        }
        if (behind) replace({entry.span.begin, behind->span.begin}, "");
        else if (before) replace({before->span.end, entry.span.end}, "");
        else replace(entry.span, "");
    }

    bool remove_one(const Path& path) {
        for (std::size_t h = 0; h < spans_.headers.size(); ++h) {
            if (!starts_with(spans_.headers[h].path, path)) continue;
            TextSpan block{line_start(text_, spans_.headers[h].span.begin), line_end(text_, last_of(h))};
            // Of the empty lines around it one set is enough.
            if (block.begin == 0 || is_empty_line(text_, line_start(text_, block.begin - 1)))
                while (block.end < text_.size() && is_empty_line(text_, block.end)) block.end = line_end(text_, block.end);
            replace(block, "");
            return true;
        }
        for (const TomlEntry& entry : spans_.entries) {
            if (!starts_with(entry.path, path)) continue;
            remove(entry);
            return true;
        }
        return false;
    }

    std::string text_;
    TomlSpans spans_;
};

/// The wires of a patch, as they are written.
struct WrittenWire {
    TomlElement element;
    std::string text;
    std::optional<PatchWire> wire;
};

std::vector<WrittenWire> wires_of(const Editing& editing) {
    std::vector<WrittenWire> wires;
    const TomlEntry* list = editing.spans().find({"wires"});
    if (!list || !list->value.of(editing.text()).starts_with('[')) return wires;
    for (const TomlElement& element : toml_elements(editing.text(), list->value)) {
        WrittenWire& written = wires.emplace_back(WrittenWire{element, {}, {}});
        written.text = toml_unquoted(element.value.of(editing.text()));
        try {
            written.wire = parse_wire(written.text, {}, false);
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
    const std::size_t from = line_start(text, element.value.begin), to = line_end(text, end);
    const bool one_line = to == line_end(text, element.value.end);
    const bool alone = one_line && is_blank(text.substr(from, element.value.begin - from)) &&
                       (is_blank(text.substr(end, to - end)) ||
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
    const std::string newline(newline_of(text));
    const TomlEntry* list = editing.spans().find({"wires"});
    if (!list) {
        const std::string lines =
            fmt::format("wires = [{0}  {1},{0}]{0}", newline, toml_quoted(joined(wire, 0)));
        std::size_t at = editing.spans().headers.empty()
                             ? text.size()
                             : line_start(text, editing.spans().headers.front().span.begin);
        for (const TomlEntry& entry : editing.spans().entries)
            if (entry.header < 0) at = line_end(text, entry.span.end);
        const bool ends_line = at == 0 || text[at - 1] == '\n';
        return editing.replace({at, at}, (ends_line ? "" : newline) + lines);
    }
    const std::vector<WrittenWire> wires = wires_of(editing);
    const std::size_t bracket = list->value.end - 1;
    if (wires.empty()) {
        const std::string made = toml_quoted(joined(wire, 0));
        const std::size_t start = line_start(text, bracket);
        if (start > list->value.begin) return editing.replace({start, start}, "  " + made + "," + newline);
        return editing.replace({bracket, bracket}, made);
    }
    const TomlElement& last = wires.back().element;
    const bool has_comma = last.comma.end > 0;
    const std::size_t end = has_comma ? last.comma.end : last.value.end;
    const std::string made = toml_quoted(joined(wire, arrow_column(wires.back().text)));
    const std::size_t behind = line_end(text, end);
    const bool has_own_line = is_blank(text.substr(line_start(text, last.value.begin),
                                                   last.value.begin - line_start(text, last.value.begin)));
    if (!has_own_line || bracket < behind)
        return editing.replace({end, end}, (has_comma ? " " : ", ") + made);
    const std::string line = indent_of(text, last.value.begin) + made + (has_comma ? "," : "") + newline;
    editing.replace({behind, behind}, line);
    if (!has_comma) editing.replace({end, end}, ",");
}

/// A wire's text with one node under another name.
std::string renamed(const std::string& wire, const PatchWire& read, std::string_view from, std::string_view to) {
    std::string text = wire;
    const auto rename_at = [&](std::size_t at) {
        at = text.find_first_not_of(" \t\r\n", at);
        text.replace(at, from.size(), to);
    };
    if (read.to_node == from) rename_at(text.find("->") + 2);
    if (read.from_node == from && !read.from_port.empty()) rename_at(0);
    return text;
}

}  // namespace

std::string with_setting(std::string_view text, std::string_view node, std::string_view name, std::string_view value) {
    Editing editing(text);
    editing.set({"nodes", std::string(node)}, name, value);
    return editing.result();
}

std::string without_setting(std::string_view text, std::string_view node, std::string_view name) {
    Editing editing(text);
    editing.reset({"nodes", std::string(node)}, name);
    return editing.result();
}

std::string with_node(std::string_view text, const NewNode& node) {
    Editing editing(text);
    editing.add_table(node);
    for (const WireText& wire : node.wires) add_element(editing, wire);
    return editing.result();
}

std::string without_node(std::string_view text, std::string_view name) {
    Editing editing(text);
    editing.remove_node(name);
    for (bool found = true; found;) {
        found = false;
        for (const WrittenWire& written : wires_of(editing)) {
            const bool ends_there = written.wire && (written.wire->to_node == name ||
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

std::string with_wire(std::string_view text, const WireText& wire) {
    Editing editing(text);
    for (const WrittenWire& written : wires_of(editing)) {
        if (!written.wire || written.wire->to_node + "." + written.wire->to_port != wire.to) continue;
        editing.replace(written.element.value, toml_quoted(joined(wire, arrow_column(written.text))));
        return editing.result();
    }
    add_element(editing, wire);
    return editing.result();
}

std::string without_wire(std::string_view text, std::string_view to) {
    Editing editing(text);
    for (const WrittenWire& written : wires_of(editing)) {
        if (!written.wire || written.wire->to_node + "." + written.wire->to_port != to) continue;
        remove_element(editing, written.element);
        return editing.result();
    }
    throw Error(fmt::format("no wire leads to '{}'", to));
}

}  // namespace tactus
